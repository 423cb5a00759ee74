//! Stored samples: 16-bit integers where the source allows, f32 only where it needs it; colours with an opacity.

use rayon::prelude::*;

/// Stored samples of a volume, x fastest, then y, then z.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// 16-bit signed. Unsigned 16-bit sources are stored minus 32768, with the intercept raised to match.
    I16(Vec<i16>),
    /// 32-bit float, for sources that 16-bit integers with one rescale cannot hold exactly.
    F32(Vec<f32>),
    /// Red, green, blue and alpha of 8 bits, straight: a volume that is already classified ([`RgbaEncoding`]). Where a
    /// number is asked for, it is alpha.
    ///
    /// [`RgbaEncoding`]: super::RgbaEncoding
    Rgba8(Vec<[u8; 4]>),
    /// The same in 16 bits.
    Rgba16(Vec<[u16; 4]>),
}

/// The affine map `value = slope · stored + intercept` (DICOM PS3.3 C.11.1.1.2, for one pair per volume).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rescale {
    /// Value per stored unit; not 0.
    pub slope: f64,
    /// Value of stored 0.
    pub intercept: f64,
}

impl Rescale {
    /// Values are the stored numbers themselves.
    pub const IDENTITY: Rescale = Rescale { slope: 1.0, intercept: 0.0 };

    /// Value of a stored number.
    pub fn value(self, stored: f64) -> f64 {
        self.slope.mul_add(stored, self.intercept)
    }

    /// Stored number of a value; the inverse of [`Rescale::value`].
    pub fn stored(self, value: f64) -> f64 {
        (value - self.intercept) / self.slope
    }
}

impl Samples {
    /// Number of samples.
    pub fn len(&self) -> usize {
        match self {
            Samples::I16(data) => data.len(),
            Samples::F32(data) => data.len(),
            Samples::Rgba8(data) => data.len(),
            Samples::Rgba16(data) => data.len(),
        }
    }

    /// True for no samples at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        match self {
            Samples::I16(data) => size_of_val(data.as_slice()),
            Samples::F32(data) => size_of_val(data.as_slice()),
            Samples::Rgba8(data) => size_of_val(data.as_slice()),
            Samples::Rgba16(data) => size_of_val(data.as_slice()),
        }
    }

    /// True for colours with an opacity.
    pub fn are_rgba(&self) -> bool {
        matches!(self, Samples::Rgba8(_) | Samples::Rgba16(_))
    }

    /// Red, green, blue and alpha in [0, 1] at a linear index, as stored: not decoded; `None` for numbers.
    pub fn rgba(&self, index: usize) -> Option<[f64; 4]> {
        match self {
            Samples::I16(_) | Samples::F32(_) => None,
            Samples::Rgba8(data) => Some(data[index].map(|x| f64::from(x) / f64::from(u8::MAX))),
            Samples::Rgba16(data) => Some(data[index].map(|x| f64::from(x) / f64::from(u16::MAX))),
        }
    }

    /// Stored number at a linear index, exact in f64.
    pub fn stored(&self, index: usize) -> f64 {
        match self {
            Samples::I16(data) => f64::from(data[index]),
            Samples::F32(data) => f64::from(data[index]),
            Samples::Rgba8(data) => f64::from(data[index][3]),
            Samples::Rgba16(data) => f64::from(data[index][3]),
        }
    }

    /// Smallest and largest stored number; `[0, 0]` if empty.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Samples::I16(data) => ends(data, |&v| v),
            Samples::F32(data) => ends(data, |&v| v),
            Samples::Rgba8(data) => ends(data, |texel| texel[3]),
            Samples::Rgba16(data) => ends(data, |texel| texel[3]),
        }
    }
}

/// Numbers whose ends are sought side by side: enough for the widest register.
const ABREAST: usize = 64;

/// Samples that a thread looks at in one go.
const PART: usize = 1 << 18;

/// Smallest and largest of the numbers in samples; `[0, 0]` if there are none.
fn ends<S: Sync, T>(samples: &[S], number: impl Fn(&S) -> T + Sync) -> [f64; 2]
where
    T: Copy + PartialOrd + Into<f64> + Send + Sync,
{
    let Some(first) = samples.first().map(&number) else { return [0.0, 0.0] };
    let of_part = |part: &[S]| {
        let (mut low, mut high) = ([first; ABREAST], [first; ABREAST]);
        let rows = part.chunks_exact(ABREAST);
        for sample in rows.remainder() {
            (low[0], high[0]) = (least(low[0], number(sample)), most(high[0], number(sample)));
        }
        for row in rows {
            for ((sample, low), high) in row.iter().zip(&mut low).zip(&mut high) {
                (*low, *high) = (least(*low, number(sample)), most(*high, number(sample)));
            }
        }
        (low.into_iter().fold(first, least), high.into_iter().fold(first, most))
    };
    let join = |a: (T, T), b: (T, T)| (least(a.0, b.0), most(a.1, b.1));
    let (low, high) = samples.par_chunks(PART).map(of_part).reduce(|| (first, first), join);
    // One zero of the two, whichever came first.
    [low.into() + 0.0, high.into() + 0.0]
}

fn least<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

fn most<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_found_wherever_they_are() {
        for count in [1, 63, 64, 65, PART - 1, PART + 70, 3 * PART + 5] {
            for at in [0, count / 2, count - 1] {
                let mut samples: Vec<i16> = (0..count).map(|v| (v % 1000) as i16).collect();
                samples[at] = -7;
                let found = Samples::I16(samples.clone()).range();
                let expected = samples.iter().fold([i16::MAX, i16::MIN], |[a, b], &v| [a.min(v), b.max(v)]);
                assert_eq!(found, expected.map(f64::from), "{count} samples, the least at {at}");
                let floats = samples.iter().map(|&v| f32::from(v)).collect();
                assert_eq!(Samples::F32(floats).range(), found, "{count} samples as floats");
            }
        }
        assert_eq!(Samples::I16(Vec::new()).range(), [0.0, 0.0]);
    }
}
