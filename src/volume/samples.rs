//! Stored samples: 16-bit integers where the source allows, f32 only where it needs it; colours with an opacity.

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
        fn ends<T: Copy + PartialOrd + Into<f64>>(mut data: impl Iterator<Item = T>) -> [f64; 2] {
            let Some(first) = data.next() else { return [0.0, 0.0] };
            let (mut low, mut high) = (first, first);
            for v in data {
                if v < low {
                    low = v;
                }
                if v > high {
                    high = v;
                }
            }
            [low.into(), high.into()]
        }
        match self {
            Samples::I16(data) => ends(data.iter().copied()),
            Samples::F32(data) => ends(data.iter().copied()),
            Samples::Rgba8(data) => ends(data.iter().map(|texel| texel[3])),
            Samples::Rgba16(data) => ends(data.iter().map(|texel| texel[3])),
        }
    }
}
