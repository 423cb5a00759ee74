//! Types that samples are stored in.

/// A type that samples are stored in; kernels are generic over it.
pub trait Voxel: Copy + Send + Sync + PartialOrd + 'static {
    /// Name in kernel names.
    const NAME: &'static str;

    /// As f32, exactly.
    fn to_f32(self) -> f32;

    /// `self − other`, rounded at most once.
    fn minus(self, other: Self) -> f32;

    /// The smaller one.
    #[inline(always)]
    #[must_use]
    fn least(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// The larger one.
    #[inline(always)]
    #[must_use]
    fn most(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
}

impl Voxel for i16 {
    const NAME: &'static str = "i16";

    #[inline(always)]
    fn to_f32(self) -> f32 {
        f32::from(self)
    }

    #[inline(always)]
    fn minus(self, other: Self) -> f32 {
        // Widened first: the difference of two 16-bit numbers has 17 bits.
        (i32::from(self) - i32::from(other)) as f32
    }
}

impl Voxel for f32 {
    const NAME: &'static str = "f32";

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }

    #[inline(always)]
    fn minus(self, other: Self) -> f32 {
        self - other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_difference_of_extremes_does_not_overflow() {
        assert_eq!(i16::MAX.minus(i16::MIN), 65535.0);
        assert_eq!(i16::MIN.minus(i16::MAX), -65535.0);
    }
}
