//! Checks on widgets and presets.

use super::{Check, join};
use crate::error::Result;
use crate::spec::source::Source;
use crate::spec::{EmissionSpec, PointSpec, Preset, Widget};

/// Checks a preset; `name` is that of its file.
pub(in crate::spec) fn check_preset(source: &Source, preset: &Preset, name: &str) -> Result<()> {
    let check = Check { source };
    check.require("version", preset.version == 1, "1")?;
    check.require("name", preset.name == name, &format!("{name}, as its file is named"))?;
    let label = preset.tissue.as_ref().map(|tissue| f64::from(tissue.label));
    check.at_least("tissue.label", label, 1.0)?;
    let concept = preset.tissue.as_ref().and_then(|tissue| tissue.snomed.as_deref());
    let digits = concept.is_none_or(|code| (6..=18).contains(&code.len()) && code.bytes().all(|b| b.is_ascii_digit()));
    check.require("tissue.snomed", digits, "a SNOMED CT identifier, 6 to 18 digits in quotes")?;
    let meaning = preset.tissue.as_ref().is_some_and(|tissue| tissue.meaning.is_some());
    check.unread("tissue.meaning", meaning && concept.is_none(), "it says what tissue.snomed is")?;
    check_widgets(check, "widgets", &preset.widgets)?;
    match &preset.classify {
        Some(widgets) => check_classifiers(check, "classify", widgets),
        None => Ok(()),
    }
}

/// Widgets of a label: shapes and nothing else, since a label has no look.
fn check_classifiers(check: Check<'_>, path: &str, widgets: &[Widget]) -> Result<()> {
    check.require(path, !widgets.is_empty(), "at least one widget")?;
    for (i, widget) in widgets.iter().enumerate() {
        let path = format!("{path}.{i}");
        let shape = check.exactly_one(&path, &shapes(widget)[..6])?;
        check_shape(check, &join(&path, shape), widget)?;
        let unread = [
            ("points", widget.points.is_some()),
            ("gradient_weight", widget.gradient_weight.is_some()),
            ("opacity_per_mm", widget.opacity_per_mm.is_some()),
            ("extinction_per_mm", widget.extinction_per_mm.is_some()),
            ("color", widget.color.is_some()),
            ("emission_per_mm", widget.emission_per_mm.is_some()),
        ];
        unread.iter().try_for_each(|(key, given)| check.unread(&join(&path, key), *given, "a label has no look"))?;
    }
    Ok(())
}

/// Every shape, and whether the widget has it; `points`, which carries its own optics, is the last.
fn shapes(widget: &Widget) -> [(&'static str, bool); 7] {
    [
        ("rectangle", widget.rectangle.is_some()),
        ("trapezoid", widget.trapezoid.is_some()),
        ("triangle", widget.triangle.is_some()),
        ("contour", widget.contour.is_some()),
        ("ellipse", widget.ellipse.is_some()),
        ("gaussian", widget.gaussian.is_some()),
        ("points", widget.points.is_some()),
    ]
}

pub(super) fn check_widgets(check: Check<'_>, path: &str, widgets: &[Widget]) -> Result<()> {
    check.require(path, !widgets.is_empty(), "at least one widget")?;
    widgets.iter().enumerate().try_for_each(|(i, widget)| check_widget(check, &format!("{path}.{i}"), widget))
}

fn check_widget(check: Check<'_>, path: &str, widget: &Widget) -> Result<()> {
    let shape = check.exactly_one(path, &shapes(widget))?;
    check_shape(check, &join(path, shape), widget)?;
    match &widget.points {
        Some(points) => check_points(check, path, widget, points),
        None => check_optics(check, path, widget),
    }
}

fn check_shape(check: Check<'_>, path: &str, widget: &Widget) -> Result<()> {
    let at = |key: &str| join(path, key);
    let ascending = |key: &str, numbers: &[f64]| {
        let rises = numbers.is_sorted() && numbers.first() < numbers.last();
        check.require(&at(key), rises, "numbers in ascending order, not all equal")
    };
    let opening_range = |[low, high]: [f64; 2]| {
        let holds = low > 0.0 && low < high;
        check.require(
            &at("gradient_hu_per_mm"),
            holds,
            "[lowest, highest], the lowest above 0: there the shape is a point",
        )
    };
    if let Some(rectangle) = &widget.rectangle {
        ascending("hu", &rectangle.hu)?;
        ascending("gradient_hu_per_mm", rectangle.gradient_hu_per_mm.as_ref().map_or(&[0.0, 1.0], |g| g.as_slice()))?;
    }
    if let Some(trapezoid) = &widget.trapezoid {
        ascending("hu", &trapezoid.hu)?;
        ascending("gradient_hu_per_mm", trapezoid.gradient_hu_per_mm.as_ref().map_or(&[0.0, 1.0], |g| g.as_slice()))?;
    }
    let mut max_deviation = None;
    if let Some(triangle) = &widget.triangle {
        check.above_zero(&at("opening_mm"), Some(triangle.opening_mm))?;
        check.require(&at("edge"), triangle.edge.is_none_or(|e| e > 0.0 && e <= 1.0), "above 0 and at most 1")?;
        opening_range(triangle.gradient_hu_per_mm)?;
        max_deviation = triangle.max_deviation;
    }
    if let Some(contour) = &widget.contour {
        check.above_zero(&at("thickness_mm"), Some(contour.thickness_mm))?;
        opening_range(contour.gradient_hu_per_mm)?;
        max_deviation = contour.max_deviation;
    }
    if let Some(ellipse) = &widget.ellipse {
        check.above_zero(&at("hu_radius"), Some(ellipse.hu_radius))?;
        check.above_zero(&at("gradient_radius_hu_per_mm"), Some(ellipse.gradient_radius_hu_per_mm))?;
        max_deviation = ellipse.max_deviation;
    }
    if let Some(gaussian) = &widget.gaussian {
        check.above_zero(&at("hu_sigma"), Some(gaussian.hu_sigma))?;
        check.above_zero(&at("gradient_sigma_hu_per_mm"), gaussian.gradient_sigma_hu_per_mm)?;
        let (mean, sigma) = (gaussian.gradient_hu_per_mm.is_some(), gaussian.gradient_sigma_hu_per_mm.is_some());
        check.needed(
            &at("gradient_sigma_hu_per_mm"),
            sigma || !mean,
            "gradient_sigma_hu_per_mm, which goes with the mean",
        )?;
        check.needed(&at("gradient_hu_per_mm"), mean || !sigma, "gradient_hu_per_mm, which goes with its sigma")?;
        max_deviation = gaussian.max_deviation;
    }
    let within = max_deviation.is_none_or(|d| (1.0 / 1024.0..=0.25).contains(&d));
    check.require(&at("max_deviation"), within, "1/1024 to 1/4")
}

/// Optics of a widget whose shape is one factor.
fn check_optics(check: Check<'_>, path: &str, widget: &Widget) -> Result<()> {
    let at = |key| join(path, key);
    check.unread(
        &at("gradient_weight"),
        widget.gradient_weight.is_some(),
        "it goes with points; this shape has its own",
    )?;
    let absorbs = check_absorption(check, path, widget.opacity_per_mm, widget.extinction_per_mm)?;
    let emission = widget.emission_per_mm.as_ref();
    check_emission(check, &at("emission_per_mm"), emission)?;
    check.needed(
        &at("opacity_per_mm"),
        absorbs || emission.is_some(),
        "opacity_per_mm, extinction_per_mm or emission_per_mm",
    )?;
    check.needed(&at("color"), !absorbs || widget.color.is_some(), "color, which what absorbs needs")?;
    check.unread(&at("color"), !absorbs && widget.color.is_some(), "the widget does not absorb; emission has its own")
}

fn check_points(check: Check<'_>, path: &str, widget: &Widget, points: &[PointSpec]) -> Result<()> {
    let at = |key: &str| join(path, key);
    let why = "points have their own";
    check.unread(&at("opacity_per_mm"), widget.opacity_per_mm.is_some(), why)?;
    check.unread(&at("extinction_per_mm"), widget.extinction_per_mm.is_some(), why)?;
    check.unread(&at("color"), widget.color.is_some(), why)?;
    check.unread(&at("emission_per_mm"), widget.emission_per_mm.is_some(), why)?;
    check.require(&at("points"), !points.is_empty(), "at least one point")?;
    check.require(&at("points"), points.is_sorted_by_key(|p| p.hu), "points in ascending order of hu")?;
    for (i, point) in points.iter().enumerate() {
        let path = at(&format!("points.{i}"));
        let at = |key| join(&path, key);
        let absorbs = check_absorption(check, &path, point.opacity_per_mm, point.extinction_per_mm)?;
        check.needed(&at("opacity_per_mm"), absorbs, "opacity_per_mm or extinction_per_mm; 0 is fine")?;
        let visible = point.opacity_per_mm.or(point.extinction_per_mm).is_some_and(|x| x > 0.0);
        check.needed(&at("color"), !visible || point.color.is_some(), "color, which what absorbs needs")?;
        check_emission(check, &at("emission_per_mm"), point.emission_per_mm.as_ref())?;
    }
    let Some(weights) = &widget.gradient_weight else { return Ok(()) };
    check.require(&at("gradient_weight"), !weights.is_empty(), "at least one [HU/mm, weight] pair")?;
    check.require(
        &at("gradient_weight"),
        weights.is_sorted_by_key(|[g, _]| *g),
        "pairs in ascending order of HU/mm",
    )?;
    check.require(&at("gradient_weight"), weights.iter().all(|[_, w]| *w >= 0.0), "weights of at least 0")
}

/// True if an opacity or an extinction is given; refuses both, and numbers out of range.
fn check_absorption(check: Check<'_>, path: &str, opacity: Option<f64>, extinction: Option<f64>) -> Result<bool> {
    let (opaque, extinct) = (opacity.is_some(), extinction.is_some());
    if opaque || extinct {
        check.exactly_one(path, &[("opacity_per_mm", opaque), ("extinction_per_mm", extinct)])?;
    }
    let share = opacity.is_none_or(|a| (0.0..=1.0).contains(&a));
    check.require(&join(path, "opacity_per_mm"), share, "0 to 1, the opacity of 1 mm")?;
    check.at_least(&join(path, "extinction_per_mm"), extinction, 0.0)?;
    Ok(opaque || extinct)
}

fn check_emission(check: Check<'_>, path: &str, emission: Option<&EmissionSpec>) -> Result<()> {
    check.at_least(&join(path, "strength"), emission.map(|e| e.strength), 0.0)
}
