//! Numbers as decimal strings: VR DS of PS3.5 §6.2, at most 16 characters.

/// The longest DS.
const MAX_LEN: usize = 16;

/// The nearest number that 16 characters can write; for lengths and directions, which it keeps to about 1e-11 of 100 mm.
pub(super) fn nearest(value: f64) -> String {
    let value = if value == 0.0 { 0.0 } else { value }; // No "-0".
    candidates(value)
        .into_iter()
        .filter(|text| text.len() <= MAX_LEN)
        .min_by(|a, b| error(a, value).total_cmp(&error(b, value)).then(a.len().cmp(&b.len())))
        .unwrap_or_else(|| "0".to_owned())
}

/// The number itself; `None` if 16 characters do not hold it.
pub(super) fn exact(value: f64) -> Option<String> {
    let text = nearest(value);
    (text.parse() == Ok(value)).then_some(text)
}

/// The shortest exact forms, and fixed and exponential forms of every number of digits.
fn candidates(value: f64) -> Vec<String> {
    let mut texts = vec![format!("{value}"), format!("{value:e}")];
    for digits in 0..MAX_LEN {
        texts.push(format!("{value:.digits$}"));
        texts.push(format!("{value:.digits$e}"));
    }
    texts
}

fn error(text: &str, value: f64) -> f64 {
    text.parse::<f64>().map_or(f64::INFINITY, |parsed| (parsed - value).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_characters_hold_a_coordinate_to_a_billionth() {
        for value in [0.0, -0.0, 1.0, -123.456_789_012_345_6, 1.0 / 3.0, -1.0 / 3.0, 1e-17, -2.5e-9, 31744.0, 6.02e23] {
            let text = nearest(value);
            let parsed: f64 = text.parse().unwrap();
            assert!(text.len() <= 16, "'{text}' has {} characters", text.len());
            assert!((parsed - value).abs() <= 1e-11 * value.abs().max(1.0), "found {text}, expected {value}");
        }
    }

    #[test]
    fn exact_refuses_what_does_not_fit() {
        assert_eq!(exact(-1024.0).as_deref(), Some("-1024"));
        assert_eq!(exact(0.1).as_deref(), Some("0.1"));
        assert_eq!(exact(1.0 / 3.0), None, "a third takes 18 characters");
    }
}
