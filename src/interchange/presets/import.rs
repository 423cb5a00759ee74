//! A volume property as a preset.

use super::function::Function;
use super::knots::{difference_of_media, refine, short};
use super::volume_property::VolumeProperty;
use super::yaml;
use crate::error::{Error, Fault, Result};
use crate::image::srgb;
use crate::spec::{Color, PointSpec, Preset, ValuesName, Widget};
use crate::transfer::shapes::extinction_per_mm;
use crate::transfer::{Optics, Side};

/// What a file does not say, and how closely it is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImportSettings {
    /// Largest deviation of the opacity and the light of a slab of any length, from 1/64 to 1024 unit distances; 10⁻⁴ to 1/4.
    pub max_deviation: f64,
    /// Unit distance in place of the file's, mm; where neither says one, 1 mm.
    pub unit_distance_mm: Option<f64>,
    /// Mean voxel spacing of the scan that the gradient opacity was set on, mm.
    pub voxel_mm: Option<f64>,
    /// What its positions measure.
    pub values: ValuesName,
    /// What its colours are.
    pub colors: ColorNumbers,
}

/// What the numbers of a colour are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColorNumbers {
    /// Those of a display, sRGB, by which people choose them: each colour is the light that it looks like.
    #[default]
    Display,
    /// Light as they are. VTK blends the numbers of a display as if they were light, and only such a preset makes its picture, as
    /// linear numbers: where translucent colours mix, another than the one of `Display`.
    Light,
}

impl ColorNumbers {
    /// The light of a number, 0 to 1.
    pub(super) fn light(self, number: f64) -> f64 {
        match self {
            ColorNumbers::Display => srgb::decode(number),
            ColorNumbers::Light => number,
        }
    }
}

impl Default for ImportSettings {
    fn default() -> Self {
        ImportSettings {
            max_deviation: 1.0 / 1024.0,
            unit_distance_mm: None,
            voxel_mm: None,
            values: ValuesName::Hu,
            colors: ColorNumbers::Display,
        }
    }
}

/// A preset with how far it is from what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The preset: one widget of points.
    pub preset: Preset,
    /// Largest deviation found, of opacity and of light of a slab of any length.
    pub max_deviation: f64,
    /// Unit distance, mm.
    pub unit_distance_mm: f64,
    /// Where gradient opacity varies: how much the opacity of a step as long as the unit distance differs in VTK, which
    /// multiplies opacities there.
    pub whole_step_difference: Option<f64>,
    /// The pipeline's shading that goes with it, where the property has some; its coefficients.
    pub shading: Option<super::Phong>,
    /// What its colours were taken for.
    pub colors: ColorNumbers,
}

impl Imported {
    /// The preset as a file, with what a reader should know above it.
    pub fn yaml(&self) -> String {
        yaml::text(self)
    }
}

/// `ct-bone` for `CT-Bone`: a preset is called by the name of its file.
pub fn preset_name(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() { c.to_lowercase().next().unwrap_or(c) } else { '-' };
    let words: String = name.chars().map(plain).collect();
    let words: Vec<&str> = words.split('-').filter(|word| !word.is_empty()).collect();
    if words.is_empty() { "imported".to_owned() } else { words.join("-") }
}

/// The preset of a volume property, by the definitions of the [module](super).
///
/// # Errors
/// `Fault::Spec` for settings out of range, and `Fault::Unsupported` for gradient opacity that varies if no voxel spacing is
/// given.
pub fn import(property: &VolumeProperty, name: &str, settings: &ImportSettings) -> Result<Imported> {
    check_bound(settings.max_deviation)?;
    let unit = settings.unit_distance_mm.or(property.unit_distance_mm).unwrap_or(1.0);
    if !(unit > 0.0 && unit.is_finite()) {
        let error = Error::new(Fault::Spec, "the unit distance is no length").found(unit.to_string());
        return Err(error.expected("mm above 0").remedy("give one by --unit-distance"));
    }
    let (points, max_deviation) = points(property, unit, settings)?;
    let varies = property.gradient_opacity.as_ref().filter(|f| f.constant().is_none());
    let gradient_weight = match (&property.gradient_opacity, varies) {
        (_, Some(function)) => Some(weight(function, settings)?),
        // 1 everywhere is what is meant by no weight.
        (Some(function), None) => function.constant().filter(|[level]| *level != 1.0).map(|[level]| vec![[0.0, level]]),
        (None, None) => None,
    };
    let widget = Widget { points: Some(points), gradient_weight, ..Widget::default() };
    let preset = Preset {
        version: 1,
        name: name.to_owned(),
        description: Some(format!("{}, imported.", property.name)),
        tissue: None,
        values: (settings.values == ValuesName::Arbitrary).then_some(ValuesName::Arbitrary),
        widgets: vec![widget],
        classify: None,
    };
    let whole_step_difference = varies.map(|gradient| whole_step_difference(&property.scalar_opacity, gradient));
    Ok(Imported {
        preset,
        max_deviation,
        unit_distance_mm: unit,
        whole_step_difference,
        shading: property.shading,
        colors: settings.colors,
    })
}

/// Refuses a bound that numbers of six digits cannot keep, or that says nothing.
pub(super) fn check_bound(max_deviation: f64) -> Result<()> {
    if (1e-4..=0.25).contains(&max_deviation) {
        return Ok(());
    }
    let error = Error::new(Fault::Spec, "the largest deviation is out of range").element("--max-deviation");
    Err(error.found(max_deviation.to_string()).expected("0.0001 to 0.25"))
}

/// What a point says at a position and side: extinction, and light per extinction.
fn optics(property: &VolumeProperty, value: f64, side: Side, unit_mm: f64, colors: ColorNumbers) -> Optics {
    let [opacity] = property.scalar_opacity.at(value, side);
    let color = property.color.at(value, side).map(|c| rounded_color(colors.light(c)));
    Optics::colored(short(extinction_per_mm(opacity, unit_mm)), color)
}

fn rounded_color(linear: f64) -> f64 {
    (linear * 1e6).round() / 1e6
}

/// Points whose lines are within the bound of the property, and the largest deviation found.
fn points(property: &VolumeProperty, unit_mm: f64, settings: &ImportSettings) -> Result<(Vec<PointSpec>, f64)> {
    let optics = |value, side| optics(property, value, side, unit_mm, settings.colors);
    let mut breaks: Vec<f64> = property.scalar_opacity.breaks();
    breaks.extend(property.color.breaks());
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let deviation = |[a, b]: [f64; 2], t: f64| {
        let ends = [optics(a, Side::Right), optics(b, Side::Left)];
        let line = Optics::NOTHING.plus(1.0 - t, ends[0]).plus(t, ends[1]);
        let (value, side) = if t < 1.0 { (a + t * (b - a), Side::Right) } else { (b, Side::Left) };
        difference_of_media(line, optics(value, side), unit_mm)
    };
    let refined = refine(&breaks, settings.max_deviation, deviation)?;
    let mut points = Vec::new();
    for &value in &refined.positions {
        let [before, after] = [Side::Left, Side::Right].map(|side| optics(value, side));
        points.push(point(value, before));
        if before != after {
            points.push(point(value, after));
        }
    }
    Ok((points, refined.max_deviation))
}

fn point(value: f64, optics: Optics) -> PointSpec {
    let Optics { extinction_per_mm: sigma, emission_per_mm } = optics;
    // What absorbs nothing has no colour.
    let color = (sigma > 0.0).then(|| Color(emission_per_mm.map(|q| rounded_color(q / sigma).clamp(0.0, 1.0))));
    PointSpec { hu: value, opacity_per_mm: None, extinction_per_mm: Some(sigma), color, emission_per_mm: None }
}

/// Gradient opacity as a weight over HU/mm, its lines within the bound.
fn weight(function: &Function<1>, settings: &ImportSettings) -> Result<Vec<[f64; 2]>> {
    let voxel_mm = settings.voxel_mm.filter(|mm| *mm > 0.0 && mm.is_finite()).ok_or_else(|| {
        Error::new(
            Fault::Unsupported,
            "the gradient opacity is in differences between voxels, whose spacing is not known",
        )
        .element("gradientOpacity")
        .remedy("give the mean voxel spacing of the scan it was set on by --voxel-mm")
    })?;
    let at = |x: f64, side| function.at(x, side)[0];
    let deviation = |[a, b]: [f64; 2], t: f64| {
        let line = (1.0 - t) * at(a, Side::Right) + t * at(b, Side::Left);
        let (x, side) = if t < 1.0 { (a + t * (b - a), Side::Right) } else { (b, Side::Left) };
        (line - at(x, side)).abs()
    };
    let refined = refine(&function.breaks(), settings.max_deviation, deviation)?;
    let sides = refined.positions.iter().flat_map(|&x| [(x, Side::Left), (x, Side::Right)]);
    let mut pairs: Vec<[f64; 2]> = sides.map(|(x, side)| [short(x / voxel_mm), short(at(x, side))]).collect();
    pairs.dedup();
    Ok(pairs)
}

/// The largest difference between `α α_g` and `1 - (1 - α)^α_g`, over the opacities of one and the other.
fn whole_step_difference(scalar: &Function<1>, gradient: &Function<1>) -> f64 {
    let ends =
        |f: &Function<1>| f.nodes().iter().map(|n| n.y[0]).fold([1.0f64, 0.0f64], |[l, h], y| [l.min(y), h.max(y)]);
    let steps = |[low, high]: [f64; 2]| (0..=256).map(move |i| low + (high - low) * f64::from(i) / 256.0);
    let pairs = steps(ends(scalar)).flat_map(|a| steps(ends(gradient)).map(move |g| (a, g)));
    pairs.map(|(a, g)| (a * g - (1.0 - (1.0 - a).powf(g))).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_those_of_files() {
        for (name, expected) in
            [("CT-Bone", "ct-bone"), ("My preset (2)", "my-preset-2"), ("../x", "x"), ("//", "imported")]
        {
            assert_eq!(preset_name(name), expected);
        }
    }
}
