//! What the samples along one axis are.

/// Defines the kinds once: variant, name in files, and the size an axis of this kind must have (0: any).
macro_rules! kinds {
    ($($variant:ident $name:literal $size:literal $doc:literal;)*) => {
        /// What the samples along one axis are (field `kinds`).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Kind {
            $(#[doc = $doc] $variant,)*
        }

        impl Kind {
            const ALL: &[(Kind, &str, usize)] = &[$((Kind::$variant, $name, $size),)*];
        }
    };
}

kinds! {
    Domain "domain" 0 "An axis of the domain that was sampled.";
    Space "space" 0 "A spatial axis.";
    Time "time" 0 "Time.";
    List "list" 0 "Values without an order of their own.";
    Point "point" 0 "Coordinates of a point.";
    Vector "vector" 0 "A contravariant vector.";
    CovariantVector "covariant-vector" 0 "A covariant vector, such as a gradient.";
    Normal "normal" 0 "A unit covariant vector.";
    Stub "stub" 1 "An axis of one sample that stands for a missing one.";
    Scalar "scalar" 1 "The one component of a scalar.";
    Complex "complex" 2 "Real and imaginary part.";
    Vector2 "2-vector" 2 "A vector of two components.";
    Color3 "3-color" 3 "A colour of three components.";
    Rgb "RGB-color" 3 "Red, green and blue.";
    Hsv "HSV-color" 3 "Hue, saturation and value.";
    Xyz "XYZ-color" 3 "Tristimulus values.";
    Color4 "4-color" 4 "A colour of four components.";
    Rgba "RGBA-color" 4 "Red, green, blue and alpha.";
    Vector3 "3-vector" 3 "A vector of three components.";
    Gradient3 "3-gradient" 3 "A gradient of three components.";
    Normal3 "3-normal" 3 "A unit normal of three components.";
    Vector4 "4-vector" 4 "A vector of four components.";
    Quaternion "quaternion" 4 "A quaternion, w first.";
    SymmetricMatrix2 "2D-symmetric-matrix" 3 "A symmetric 2 x 2 matrix.";
    MaskedSymmetricMatrix2 "2D-masked-symmetric-matrix" 4 "A mask and a symmetric 2 x 2 matrix.";
    Matrix2 "2D-matrix" 4 "A 2 x 2 matrix.";
    MaskedMatrix2 "2D-masked-matrix" 5 "A mask and a 2 x 2 matrix.";
    SymmetricMatrix3 "3D-symmetric-matrix" 6 "A symmetric 3 x 3 matrix.";
    MaskedSymmetricMatrix3 "3D-masked-symmetric-matrix" 7 "A mask and a symmetric 3 x 3 matrix.";
    Matrix3 "3D-matrix" 9 "A 3 x 3 matrix.";
    MaskedMatrix3 "3D-masked-matrix" 10 "A mask and a 3 x 3 matrix.";
}

impl Kind {
    /// The kind of this name, in any case and with or without its hyphens.
    pub fn from_name(name: &str) -> Option<Self> {
        let plain = |s: &str| s.chars().filter(|c| !matches!(c, '-' | '_' | ' ')).collect::<String>().to_lowercase();
        let wanted = plain(name);
        Kind::ALL.iter().find(|(_, name, _)| plain(name) == wanted).map(|(kind, ..)| *kind)
    }

    /// The name in files.
    pub fn name(self) -> &'static str {
        self.row().1
    }

    /// The number of samples an axis of this kind has, where the kind says so.
    pub fn size(self) -> Option<usize> {
        Some(self.row().2).filter(|&size| size != 0)
    }

    /// True for the axes along which a volume extends in space.
    pub fn is_spatial(self) -> bool {
        matches!(self, Kind::Domain | Kind::Space)
    }

    /// True for the components of a colour.
    pub fn is_color(self) -> bool {
        matches!(self, Kind::Color3 | Kind::Rgb | Kind::Hsv | Kind::Xyz | Kind::Color4 | Kind::Rgba)
    }

    fn row(self) -> &'static (Kind, &'static str, usize) {
        &Kind::ALL[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_found_by_its_own_name() {
        for &(kind, name, size) in Kind::ALL {
            assert_eq!(Kind::from_name(name), Some(kind), "{name}");
            assert_eq!((kind.name(), kind.size().unwrap_or(0)), (name, size), "{name}: the table's own row");
        }
        assert_eq!(Kind::from_name("rgbacolor"), Some(Kind::Rgba), "hyphens and case do not matter");
        assert_eq!(Kind::from_name("colour"), None, "an unknown name");
    }
}
