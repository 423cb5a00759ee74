//! Volumes of colours with an opacity.

use glam::{DAffine3, DMat3, DVec3};
use pellucid::io::nrrd::{self, Encoding};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};

use super::Folder;

const LPS: &str = "NRRD0004\ndimension: 4\nspace: left-posterior-superior\nspace origin: (1,2,3)\n";
const STEPS: &str = "(0.5,0,0) (0,0.5,0) (0,0,2)";

fn volume(samples: Samples) -> Volume {
    let steps = DMat3::from_cols(DVec3::new(0.1, 0.3, 0.0), DVec3::new(-0.2, 0.5, 0.3), DVec3::new(0.0, 0.7, -5.0));
    let grid = Grid::new([4, 3, 2], DAffine3::from_mat3_translation(steps, DVec3::new(7.0, -3.5, 1e3))).unwrap();
    Volume::new(grid, samples, Rescale::IDENTITY, Quantity::Arbitrary).unwrap()
}

#[test]
fn colors_come_back_from_every_encoding() {
    let folder = Folder::new();
    let path = folder.path("a.nrrd");
    let eight = volume(Samples::Rgba8((0..24_u8).map(|i| [i, 255 - i, 7 * i, 10 * i]).collect()));
    let sixteen = volume(Samples::Rgba16((0..24_u16).map(|i| [i, 65_535 - i, 700 * i, 2500 * i]).collect()));
    for (original, element_type) in [(eight, "uint8"), (sixteen, "uint16")] {
        for encoding in [Encoding::Raw, Encoding::Gzip, Encoding::Bzip2, Encoding::Text, Encoding::Hex] {
            nrrd::write(&path, &original, encoding, &[]).unwrap();
            let scan = nrrd::read(&path).unwrap_or_else(|e| panic!("{encoding:?}: {e}"));
            assert_eq!(scan.volume, original, "{encoding:?}");
            assert_eq!(scan.warnings, Vec::<String>::new(), "{encoding:?}");
            let (header, _) = nrrd::read_header(&path).unwrap();
            assert_eq!(header.shape(), "4 (RGBA-color) x 4 x 3 x 2");
            assert_eq!(header.element_type.name(), element_type);
        }
    }
}

#[test]
fn components_may_lie_along_any_axis() {
    let folder = Folder::new();
    let first =
        format!("{LPS}sizes: 4 1 2 1\nspace directions: none {STEPS}\nkinds: RGBA-color domain domain domain\n");
    let last = format!("{LPS}sizes: 1 2 1 4\nspace directions: {STEPS} none\nkinds: domain domain domain RGBA-color\n");
    let second = format!(
        "{LPS}sizes: 1 4 2 1\nspace directions: (0.5,0,0) none (0,0.5,0) (0,0,2)\nkinds: space rgbacolor space space\n"
    );
    let together = [10, 11, 12, 13, 20, 21, 22, 23];
    let apart = [10, 20, 11, 21, 12, 22, 13, 23];
    for (header, bytes) in [(first, together), (second, together), (last, apart)] {
        let text = format!("{header}type: uint8\nencoding: raw\n");
        let scan = nrrd::read(&folder.nrrd("a.nrrd", &text, &bytes)).unwrap_or_else(|e| panic!("{header}: {e}"));
        assert_eq!(scan.volume.grid().dims(), [1, 2, 1], "{header}");
        assert_eq!(scan.volume.grid().spacing_mm(), DVec3::new(0.5, 0.5, 2.0), "{header}");
        let expected = Samples::Rgba8(vec![[10, 11, 12, 13], [20, 21, 22, 23]]);
        assert_eq!(scan.volume.samples(), &expected, "{header}");
        assert_eq!(scan.volume.rgba_encoding().map(|e| e.opacity_length_mm), Some(0.5), "{header}");
    }
}

#[test]
fn colors_without_an_opacity_are_refused_with_a_remedy() {
    let folder = Folder::new();
    for (components, kind) in [(3, "RGB-color"), (4, "4-color"), (3, "vector"), (4, "???")] {
        let header = format!(
            "{LPS}sizes: {components} 1 2 1\nspace directions: none {STEPS}\nkinds: {kind} domain domain domain\n\
             type: uint8\nencoding: raw\n"
        );
        let found = folder.error(&folder.nrrd("a.nrrd", &header, &vec![0; 2 * components]));
        assert!(found.contains("the colours have no opacity, or do not say that they have one"), "{kind}: {found}");
        assert!(found.contains("write the kind RGBA-color"), "{kind}: {found}");
    }
}

#[test]
fn components_are_unsigned_integers() {
    let folder = Folder::new();
    let header =
        format!("{LPS}sizes: 4 1 1 1\nspace directions: none {STEPS}\nkinds: RGBA-color domain domain domain\n");
    for (element_type, bytes) in [("float", 16), ("int16", 8), ("int8", 4)] {
        let text = format!("{header}type: {element_type}\nendian: little\nencoding: raw\n");
        let found = folder.error(&folder.nrrd("a.nrrd", &text, &vec![0; bytes]));
        assert!(found.contains("of a type that is not read here") && found.contains("uint8 or uint16"), "{found}");
    }
}
