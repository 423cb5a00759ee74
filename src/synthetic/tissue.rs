//! What solids are made of, in HU.

use glam::Vec3;

use super::noise::value_noise;

/// What fills a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Material {
    /// The same value everywhere, HU.
    Uniform(f32),
    /// A marbled value: `mean_hu` ± `swing_hu`, in grains of `grain_mm`.
    Spongy { mean_hu: f32, swing_hu: f32, grain_mm: f32 },
    /// Air in cells of `cell_mm` with bony walls between them.
    AirCells { cell_mm: f32 },
    /// White matter with grey folds along the surface and CSF between them, folded every `fold_mm`.
    Folded { fold_mm: f32 },
}

pub(super) const AIR_HU: f32 = -1000.0;
pub(super) const GREY_MATTER_HU: f32 = 38.0;
pub(super) const WHITE_MATTER_HU: f32 = 28.0;

pub(super) const AIR: Material = Material::Uniform(AIR_HU);
pub(super) const FAT: Material = Material::Uniform(-100.0);
pub(super) const CSF: Material = Material::Uniform(5.0);
pub(super) const VITREOUS: Material = Material::Uniform(10.0);
pub(super) const GLAND: Material = Material::Uniform(20.0);
pub(super) const SKIN: Material = Material::Uniform(40.0);
pub(super) const GREY: Material = Material::Uniform(GREY_MATTER_HU);
pub(super) const WHITE: Material = Material::Uniform(WHITE_MATTER_HU);
pub(super) const MUSCLE: Material = Material::Uniform(55.0);
pub(super) const DURA: Material = Material::Uniform(60.0);
pub(super) const LENS: Material = Material::Uniform(90.0);
pub(super) const DISC: Material = Material::Uniform(90.0);
pub(super) const THYROID: Material = Material::Uniform(110.0);
pub(super) const SUTURE: Material = Material::Uniform(250.0);
pub(super) const CARTILAGE: Material = Material::Uniform(130.0);
pub(super) const CALCIFICATION: Material = Material::Uniform(250.0);
pub(super) const CONTRAST: Material = Material::Uniform(300.0);
pub(super) const THIN_BONE: Material = Material::Uniform(700.0);
pub(super) const CORTICAL: Material = Material::Uniform(1250.0);
pub(super) const DENTINE: Material = Material::Uniform(1500.0);
pub(super) const ENAMEL: Material = Material::Uniform(2500.0);
pub(super) const FILLING: Material = Material::Uniform(3000.0);
pub(super) const DIPLOE: Material = Material::Spongy { mean_hu: 420.0, swing_hu: 160.0, grain_mm: 2.6 };
pub(super) const VERTEBRAL_SPONGE: Material = Material::Spongy { mean_hu: 320.0, swing_hu: 110.0, grain_mm: 2.4 };

/// Depth of the brain's furrows in units of the distance between them.
const FURROW_DEPTH_FOLDS: f32 = 1.3;

impl Material {
    /// The depth, mm, beyond which the value no longer depends on it.
    pub(super) fn varies_to_mm(self) -> f32 {
        if let Material::Folded { fold_mm } = self { FURROW_DEPTH_FOLDS * fold_mm } else { 0.0 }
    }

    /// Value at `p`, `depth_mm` beneath the surface of the solid that it fills.
    pub(super) fn hu(self, p: Vec3, depth_mm: f32) -> f32 {
        match self {
            Material::Uniform(hu) => hu,
            Material::Spongy { mean_hu, swing_hu, grain_mm } => mean_hu + swing_hu * value_noise(1, p / grain_mm),
            Material::AirCells { cell_mm } => {
                let wall = 1.0 - smooth_step(0.06, 0.22, value_noise(2, p / cell_mm).abs());
                mix(AIR_HU + 60.0, 420.0, wall)
            }
            Material::Folded { fold_mm } => folded_hu(p, depth_mm, fold_mm),
        }
    }
}

/// Brain: furrows are where a warped noise crosses 0; they are a little deeper than they are apart, filled with CSF and lined with grey
/// matter, as the surface between them is.
fn folded_hu(p: Vec3, depth_mm: f32, fold_mm: f32) -> f32 {
    let open = 1.0 - smooth_step(0.7, FURROW_DEPTH_FOLDS, depth_mm / fold_mm);
    let from_furrow_mm = if open > 0.0 { distance_from_furrow_mm(p, fold_mm) } else { fold_mm };
    let grey_mm = 0.25 * fold_mm;
    let lining = (1.0 - smooth_step(0.7 * grey_mm, 1.3 * grey_mm, from_furrow_mm)) * open;
    let mantle = 1.0 - smooth_step(0.7 * grey_mm, 1.3 * grey_mm, depth_mm);
    let matter = mix(WHITE_MATTER_HU, GREY_MATTER_HU, lining.max(mantle));
    let csf = (1.0 - smooth_step(0.2, 1.1, from_furrow_mm)) * open;
    mix(matter, 8.0, csf)
}

/// Distance to the nearest zero of the noise, to first order: its value over its slope.
fn distance_from_furrow_mm(p: Vec3, fold_mm: f32) -> f32 {
    let q = p / (1.25 * fold_mm);
    let warp = Vec3::new(value_noise(3, 0.9 * q), value_noise(4, 0.9 * q), value_noise(5, 0.9 * q));
    let q = q + 0.6 * warp;
    // Two lattices askew to each other hide each other's axes.
    let askew = |q: Vec3| Vec3::new(0.8 * q.x + 0.6 * q.y, 0.8 * q.y - 0.6 * q.x, q.z + 0.3 * q.x + 0.5 * q.y);
    let field = |q: Vec3| value_noise(6, q) + 0.8 * value_noise(8, 1.2 * askew(q));
    const STEP: f32 = 0.05;
    let here = field(q);
    let slope = Vec3::new(field(q + STEP * Vec3::X), field(q + STEP * Vec3::Y), field(q + STEP * Vec3::Z)) - here;
    here.abs() / (slope.length() / STEP + 0.2) * 1.25 * fold_mm
}

/// 0 up to `low`, 1 from `high`, and Hermite's cubic between.
pub(super) fn smooth_step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// `a` for `t` = 0, `b` for `t` = 1.
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}
