//! A pipeline file: from a scan to a picture.

use std::collections::BTreeMap;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AnalyticSpec, CameraSpec, CleanSpec, Color, EffectsSpec, IntegrateSpec, ViewsSpec, Widget};

/// A pipeline: which scan, what of it shows, from where, how exactly it is integrated, and the picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "pellucid pipeline")]
pub struct Pipeline {
    /// Version of this form: 1.
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// The scan.
    pub volume: VolumeSpec,
    /// Window of values that the transfer function covers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normalise: Option<NormaliseSpec>,
    /// Range of gradient magnitudes that the transfer function covers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient: Option<GradientSpec>,
    /// What shows: the sum of these layers. At least one, unless an effect shows something else than light or the volume has
    /// colours of its own.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transfer_function: Vec<LayerSpec>,
    /// How `classify` cleans its labels: lists of steps, by the name of a layer, or under `all` for those without a list of
    /// their own. None by default; a picture has no labels and reads none of it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub clean: BTreeMap<String, Vec<CleanSpec>>,
    /// Effects beyond emission and absorption; none by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effects: Option<EffectsSpec>,
    /// From where; the whole volume from the front by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraSpec>,
    /// From several sides, a picture each; from one by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub views: Option<ViewsSpec>,
    /// How the volume rendering integral is computed; `exact` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integrate: Option<IntegrateSpec>,
    /// The picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageSpec>,
    /// How many random pixels the oracle recomputes, to state the error reached; none by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub certify: Option<u32>,
    /// The file to write, `.png` or `.exr`, relative to the pipeline's file; by default the pipeline's name with `.png`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<PathBuf>,
}

/// The scan: exactly one of `source`, `phantom` and `analytic`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VolumeSpec {
    /// A DICOM folder or a `.nrrd`, `.nhdr`, `.nii` or `.nii.gz` file, relative to the pipeline's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<PathBuf>,
    /// A volume made by rule, in HU.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phantom: Option<PhantomSpec>,
    /// A formula, sampled; its values are arbitrary unless `values` says otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub analytic: Option<AnalyticSpec>,
    /// Which series of a DICOM folder: `largest`, the default, or a Series Instance UID.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<Series>,
    /// Whether the distance between DICOM slices may change: `even`, the default, refuses such a series, `uneven` renders
    /// it as it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slices: Option<SlicesName>,
    /// What the values measure; by default what the file says, and arbitrary for a formula.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub values: Option<ValuesName>,
    /// Added to every value to make it HU, such as -1024 for scans stored as HU + 1024. The values are then HU.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift_hu: Option<f64>,
    /// Length that the alpha of an RGBA volume is the opacity of, mm, above 0; its smallest spacing by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity_length_mm: Option<f64>,
    /// What the numbers of an RGBA volume's colours are; `srgb` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color_encoding: Option<ColorEncodingName>,
}

/// What the numbers of a colour are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ColorEncodingName {
    /// sRGB (IEC 61966-2-1), as pictures have them.
    Srgb,
    /// Linear light.
    Linear,
}

/// A volume made by rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum PhantomSpec {
    /// A head with skin, skull and brain.
    Head(PhantomBody),
    /// A chest in the arterial phase, with ribs, lungs and heart.
    Chest(PhantomBody),
    /// Three rings in changing colours, an RGBA volume.
    Rings(PhantomRings),
}

/// Settings of the rings.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhantomRings {
    /// Voxels along each side; 64 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 1024))]
    pub size: Option<u32>,
}

/// Settings of a phantom of the body.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhantomBody {
    /// Voxels along x and along y; 256 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 1024))]
    pub size: Option<u32>,
    /// Seed of its noise; 1 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// Which series of a DICOM folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "String", into = "String")]
#[schemars(with = "String")]
pub enum Series {
    /// The one with the most slices.
    Largest,
    /// The one with this Series Instance UID.
    Uid(String),
}

impl From<String> for Series {
    fn from(text: String) -> Self {
        if text == "largest" { Series::Largest } else { Series::Uid(text) }
    }
}

impl From<Series> for String {
    fn from(series: Series) -> Self {
        match series {
            Series::Largest => "largest".to_owned(),
            Series::Uid(uid) => uid,
        }
    }
}

/// Whether the distance between slices may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SlicesName {
    /// It must not.
    Even,
    /// It may; nothing is resampled.
    Uneven,
}

/// What the values of a volume measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ValuesName {
    /// Hounsfield units.
    Hu,
    /// Numbers of unknown meaning; presets in HU do not apply to them.
    Arbitrary,
}

/// Window of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NormaliseSpec {
    /// Lowest and highest value the transfer function tells apart, HU (or the volume's own values);
    /// `[-1024, 3071]` by default.
    pub hu: [f64; 2],
}

/// Range of gradient magnitudes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GradientSpec {
    /// 0 and the highest gradient magnitude the transfer function tells apart, HU/mm; `[0, 1500]` by default.
    pub range_hu_per_mm: [f64; 2],
}

/// One layer of the transfer function: exactly one of `preset`, `widgets` and `attenuation`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LayerSpec {
    /// A preset: its name, or a path ending in `.yaml` relative to the pipeline's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// Widgets written here, in the volume's own values.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub widgets: Option<Vec<Widget>>,
    /// Attenuation of X-rays at a photon energy, from HU; it absorbs and has no colour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attenuation: Option<AttenuationSpec>,
    /// Multiplies extinction and emission; 1 by default, at least 0. An opacity α per mm becomes 1 − (1 − α)^scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub opacity_scale: Option<f64>,
    /// Colour in place of those of the widgets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Multiplies the layer's positions on the value and gradient axes, before the shift; 1 by default, above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Added to the layer's positions on the value axis, HU; 0 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift_hu: Option<f64>,
}

/// Attenuation of X-rays by air, water and bone; see [`crate::transfer::attenuation`] for its definition and source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttenuationSpec {
    /// Photon energy of the radiograph, keV.
    #[schemars(range(min = 10, max = 200))]
    pub kev: f64,
    /// Effective photon energy of the scan, keV; 70 by default, as of a tube at 120 kVp.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 10, max = 200))]
    pub scanned_at_kev: Option<f64>,
}

/// The picture.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageSpec {
    /// Width and height in pixels; `[1024, 1024]` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 1, max = 65535)))]
    pub size: Option<[u32; 2]>,
    /// Light behind the volume; `black` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub background: Option<BackgroundSpec>,
    /// Bits per channel of a PNG; 8 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bits: Option<Bits>,
}

/// Bits per channel of a PNG.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "u32", into = "u32")]
#[schemars(extend("enum" = [8, 16]), with = "u32")]
pub enum Bits {
    /// 8 bits.
    Eight,
    /// 16 bits.
    Sixteen,
}

impl TryFrom<u32> for Bits {
    type Error = String;

    fn try_from(bits: u32) -> Result<Self, String> {
        match bits {
            8 => Ok(Bits::Eight),
            16 => Ok(Bits::Sixteen),
            other => Err(format!("bits per channel are 8 or 16, not {other}")),
        }
    }
}

impl From<Bits> for u32 {
    fn from(bits: Bits) -> u32 {
        match bits {
            Bits::Eight => 8,
            Bits::Sixteen => 16,
        }
    }
}

/// Light behind the volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BackgroundSpec {
    /// None: the picture keeps its alpha.
    Transparent,
    /// An even colour; the picture is opaque.
    Color(Color),
}
