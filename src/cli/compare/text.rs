//! A comparison in a few lines.

use pellucid::image::metrics::Comparison;

/// The numbers as people read them; differences in units of one step of 8 bits too.
pub(super) fn text(comparison: &Comparison, tolerance: f64) -> String {
    let Comparison { difference, .. } = comparison;
    let steps = |d: f64| format!("{d:.3e} ({:.3}/255)", 255.0 * d);
    let channels = |values: [f64; 4]| values.map(|v| format!("{v:.2e}")).join(" ");
    let percent = 100.0 * difference.pixels_over as f64 / difference.pixels as f64;
    let psnr = comparison.psnr_db.map_or("infinite".to_string(), |db| format!("{db:.2} dB"));
    let ssim = comparison.ssim.map_or("picture too small".to_string(), |s| s.map(|v| format!("{v:.6}")).join(" "));
    let mut lines = vec![
        format!("largest      {}; r g b a: {}", steps(comparison.max_abs_all), channels(difference.max_abs)),
        format!("99.9 % below {}", steps(comparison.error_of_999_in_1000)),
        format!("RMS          {}; r g b a: {}", steps(comparison.rms_all), channels(difference.rms)),
        format!("PSNR         {psnr}"),
        format!("SSIM         r g b a: {ssim}"),
        format!("CIEDE2000    mean {:.4}, largest {:.3}", comparison.delta_e_2000.mean, comparison.delta_e_2000.max),
        format!("FLIP         mean {:.5}, largest {:.4}", comparison.flip.mean, comparison.flip.max),
        format!("above {tolerance:.3e}: {} of {} pixels ({percent:.3} %)", difference.pixels_over, difference.pixels),
    ];
    if let Some(worst) = difference.worst {
        let pixel = |p: [f32; 4]| p.map(|v| format!("{v:.5}")).join(" ");
        let [a, b] = worst.values.map(pixel);
        lines.push(format!("worst pixel  column {}, row {}: ({a}) and ({b})", worst.column, worst.row));
    }
    lines.join("\n")
}
