//! Stored samples: 16-bit integers where the source allows, f32 only where it needs it.

/// Stored samples of a volume, x fastest, then y, then z.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// 16-bit signed. Unsigned 16-bit sources are stored minus 32768, with the intercept raised to match.
    I16(Vec<i16>),
    /// 32-bit float, for sources that 16-bit integers with one rescale cannot hold exactly.
    F32(Vec<f32>),
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
        }
    }

    /// Stored number at a linear index, exact in f64.
    pub fn stored(&self, index: usize) -> f64 {
        match self {
            Samples::I16(data) => f64::from(data[index]),
            Samples::F32(data) => f64::from(data[index]),
        }
    }

    /// Smallest and largest stored number; `[0, 0]` if empty.
    pub fn range(&self) -> [f64; 2] {
        fn ends<T: Copy + PartialOrd + Into<f64>>(data: &[T]) -> [f64; 2] {
            let Some(&first) = data.first() else { return [0.0, 0.0] };
            let (mut low, mut high) = (first, first);
            for &v in data {
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
            Samples::I16(data) => ends(data),
            Samples::F32(data) => ends(data),
        }
    }
}
