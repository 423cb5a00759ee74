//! From numbers to pixels, and the numbers that are written beside them.

/// A linear scale: `from` is at pixel `at`, `to` at pixel `end`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Linear {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) at: f64,
    pub(super) end: f64,
}

impl Linear {
    /// The pixel of a number.
    pub(super) fn pixel(&self, x: f64) -> f64 {
        self.at + (x - self.from) / (self.to - self.from) * (self.end - self.at)
    }

    /// Round numbers from end to end, about so many.
    pub(super) fn ticks(&self, about: usize) -> Vec<f64> {
        let raw = (self.to - self.from) / about as f64;
        let power = 10f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|s| *s >= raw).unwrap_or(raw);
        // Rounding must not cost the tick at an end.
        let slack = 1e-9;
        let (first, last) = ((self.from / step - slack).ceil() as i64, (self.to / step + slack).floor() as i64);
        (first..=last).map(|n| n as f64 * step).collect()
    }
}

/// Counts on a logarithmic scale: where 1 is 0 and the highest count 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Logarithmic {
    pub(super) highest: u64,
}

impl Logarithmic {
    /// Share of the scale for a count of at least 1; 1 where the highest is 1.
    pub(super) fn share(&self, count: u64) -> f64 {
        if self.highest <= 1 { 1.0 } else { (count as f64).ln() / (self.highest as f64).ln() }
    }

    /// The powers of ten on the scale.
    pub(super) fn ticks(&self) -> Vec<u64> {
        std::iter::successors(Some(1_u64), |n| n.checked_mul(10)).take_while(|n| *n <= self.highest).collect()
    }
}

/// Positive numbers on a logarithmic scale between two pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decades {
    from: f64,
    to: f64,
    pixels: [f64; 2],
}

impl Decades {
    /// The numbers and some room around them; one decade where there are none.
    pub(super) fn around(numbers: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let [low, high] = numbers.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], x| [low.min(x), high.max(x)]);
        let [from, to] = if low.is_finite() { [low / 1.6, high * 1.6] } else { [1.0, 10.0] };
        Decades { from, to, pixels }
    }

    /// The pixel of a number.
    pub(super) fn pixel(&self, x: f64) -> f64 {
        let [at, end] = self.pixels;
        at + (x / self.from).ln() / (self.to / self.from).ln() * (end - at)
    }

    /// Powers of ten on the scale.
    pub(super) fn powers(&self) -> Vec<f64> {
        self.multiples(&[1.0])
    }

    /// Twice to nine times the powers of ten.
    pub(super) fn between(&self) -> Vec<f64> {
        self.multiples(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0])
    }

    /// Numbers to write beside the scale: powers of ten; with 2 and 5 between them where there would be few.
    pub(super) fn labels(&self) -> Vec<(f64, String)> {
        let numbers = if self.powers().len() < 3 { self.multiples(&[1.0, 2.0, 5.0]) } else { self.powers() };
        numbers.into_iter().map(|x| (x, decimal(x))).collect()
    }

    fn multiples(&self, digits: &[f64]) -> Vec<f64> {
        let (first, last) = (self.from.log10().floor() as i32, self.to.log10().ceil() as i32);
        let of_power = |power: i32| digits.iter().map(move |digit| digit * 10f64.powi(power));
        (first..=last).flat_map(of_power).filter(|x| (self.from..=self.to).contains(x)).collect()
    }
}

/// One digit times a power of ten: in full where that is short, else `10⁻³` or `2·10⁻³`.
fn decimal(x: f64) -> String {
    if (0.000_999..10_001.0).contains(&x) {
        return format!("{}", (x * 1e4).round() / 1e4);
    }
    let power = (x.log10() + 1e-9).floor();
    let digit = (x / 10f64.powf(power)).round();
    let raised: String = format!("{power}").chars().map(superscript).collect();
    if digit == 1.0 { format!("10{raised}") } else { format!("{digit}·10{raised}") }
}

fn superscript(c: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize])
}

/// A number as people write it: a true minus, no digits beyond those that a step of ticks needs.
pub(super) fn label(x: f64, step: f64) -> String {
    let decimals = (-(step.log10() + 1e-9).floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{:.decimals$}", x.abs());
    if x < 0.0 && text.contains(|c: char| ('1'..='9').contains(&c)) { format!("−{text}") } else { text }
}

/// A count with thin spaces between groups of three digits.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (n, digit) in digits.chars().enumerate() {
        if n > 0 && (digits.len() - n).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_include_the_ends() {
        let ticks = |from, to| Linear { from, to, at: 0.0, end: 1.0 }.ticks(8);
        assert_eq!(ticks(-1000.0, 3000.0), [-1000.0, -500.0, 0.0, 500.0, 1000.0, 1500.0, 2000.0, 2500.0, 3000.0]);
        assert_eq!(ticks(0.0, 0.3).len(), 7, "steps of 0.05: {:?}", ticks(0.0, 0.3));
        assert_eq!(ticks(-1024.0, 3071.0).first(), Some(&-1000.0));
    }

    #[test]
    fn counts_are_logarithmic() {
        let scale = Logarithmic { highest: 10_000 };
        assert!((scale.share(100) - 0.5).abs() < 1e-12 && scale.share(1) == 0.0 && scale.share(10_000) == 1.0);
        assert_eq!(scale.ticks(), [1, 10, 100, 1000, 10_000]);
        assert_eq!((Logarithmic { highest: 1 }.share(1), Logarithmic { highest: 0 }.ticks()), (1.0, vec![]));
    }

    #[test]
    fn decades_are_labelled_and_a_few_of_them_more_densely() {
        let texts = |numbers: [f64; 2]| {
            let labels = Decades::around(numbers.into_iter(), [0.0, 100.0]).labels();
            labels.into_iter().map(|(_, text)| text).collect::<Vec<_>>()
        };
        assert_eq!(texts([2e-4, 30.0]), ["0.001", "0.01", "0.1", "1", "10"]);
        assert_eq!(texts([0.3, 4.0]), ["0.2", "0.5", "1", "2", "5"]);
        assert_eq!(texts([1e-7, 2e-7]), ["10⁻⁷", "2·10⁻⁷"], "below the room around them is nothing round");
        let scale = Decades::around([1.6, 100.0 / 1.6].into_iter(), [0.0, 100.0]);
        assert!((scale.pixel(10.0) - 50.0).abs() < 1e-9, "the middle, found {}", scale.pixel(10.0));
    }

    #[test]
    fn labels_are_as_people_write_them() {
        assert_eq!([(-1000.0, 500.0), (0.0, 500.0), (-0.0, 1.0)].map(|(x, step)| label(x, step)), ["−1000", "0", "0"]);
        assert_eq!([(0.25, 0.05), (1.5, 0.5)].map(|(x, step)| label(x, step)), ["0.25", "1.5"]);
        assert_eq!(grouped(1_234_567), "1\u{2009}234\u{2009}567");
        assert_eq!([grouped(0), grouped(999)], ["0", "999"]);
    }
}
