#!/bin/sh
# Renders the pictures of presets/README.md: a preset each, on a scan that it fits.
#   presets/pictures.sh PELLUCID [NAME…]
# PELLUCID is the program; the scans are those of tests/README.md, below PELLUCID_DATA (../shared/data unless told). A name
# renders one picture only.
set -eu
cd "$(dirname "$0")/.."
pellucid=$1
shift
data=$(cd "${PELLUCID_DATA:-../shared/data}" && pwd)
mkdir -p presets/pictures
pipeline=$(mktemp -d)
trap 'rm -rf "$pipeline"' EXIT

head="phantom: { head: { size: 160 } }"
chest="phantom: { chest: { size: 200 } }"
body="source: $data/abdomen/ct.nrrd, values: hu"
face="view: anterior, azimuth: 35, elevation: 5, fit: volume, zoom: 1.35"
mouth="view: anterior, azimuth: 20, elevation: 10, fit: volume, zoom: 2"
front="view: anterior, azimuth: 15, zoom: 1.3"
octets="normalise: { hu: [0, 255] }, gradient: { range_hu_per_mm: [0, 100] }"

wanted="$*"

# picture NAME 'VOLUME' 'CAMERA' ['MORE EFFECTS' ['MORE KEYS' ['OF THE LAYER']]]
picture() {
    case " $wanted " in *" $1 "* | "  ") ;; *) return 0 ;; esac
    printf '{ version: 1, volume: { %s }, transfer_function: [{ preset: "%s"%s }],
              effects: { shading: { ambient: 0.3, diffuse: 0.7 }%s }, camera: { %s },
              image: { size: [160, 160], background: "#10141c" }%s }\n' \
        "$2" "$PWD/presets/$1.yaml" "${6:+, $6}" "${4:+, $4}" "$3" "${5:+, $5}" > "$pipeline/$1.yaml"
    "$pellucid" render "$pipeline/$1.yaml" --quiet -o "presets/pictures/$1.png"
    rm -f "presets/pictures/$1.png.json" "presets/pictures/$1.json"
}

# Only these structures of a phantom, or these organs of the abdomen by their numbers.
structures() { printf 'mask: { phantom: structures, default: hide, labels: { %s } }' "$1"; }
organs() { printf 'mask: { source: "%s/abdomen/labels.nrrd", default: hide, labels: { %s } }' "$data" "$1"; }

picture airways "$head" "$face" "$(structures 'airways: show, muscle: show, brain: show')"
picture bone "$head" "$face"
picture bone-cortical "$head" "$face"
picture bone-trabecular "$body" "$front"
picture bowel-gas "$body" "$front" "$(organs '6: show, 18: show, 19: show, 20: show')"
picture brain "$head" "$face" "$(structures 'brain: show')"
picture enamel "$head" "$mouth"
picture engine "source: $data/engine.nrrd, values: arbitrary" "view: superior, azimuth: 35, elevation: -35, zoom: 1.4" "" "$octets"
picture fat "$body" "$front" "" "" "opacity_scale: 0.3"
picture heart "$chest" "view: anterior, azimuth: 15, elevation: 5, fit: volume, zoom: 1.8" "$(structures 'heart: show, vessels: show')"
picture kidneys "$body" "$front" "$(organs '2: show, 3: show')" "" "shift_hu: -130"
picture liver "$body" "$front" "$(organs '5: show')" "" "shift_hu: -50"
picture lung "$body" "$front" "$(organs '10: show, 11: show, 14: show')"
picture metal "$body" "$front"
picture muscle "$body" "$front"
picture skin "$head" "$face"
picture soft-tissue "$head" "$face"
picture teeth "$head" "$mouth"
picture tooth "source: $data/tooth.nrrd, values: arbitrary" "view: anterior, azimuth: 30, elevation: 10, zoom: 1.15" "" "$octets"
picture tooth-boundaries "source: $data/tooth.nrrd, values: arbitrary" "view: anterior, azimuth: 30, elevation: 10, zoom: 1.15" "" "$octets"
picture vessels "$head" "$face" "$(structures 'vessels: show')"
