//! The fields of a header, by name.

/// Defines the fields once: variant, and its names without blanks.
macro_rules! fields {
    ($($variant:ident $($name:literal)+;)*) => {
        /// A field of the format's definition.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub(super) enum Field {
            $($variant,)*
        }

        const NAMES: &[(Field, &str)] = &[$($((Field::$variant, $name),)+)*];
    };
}

fields! {
    Content "content";
    Number "number";
    Type "type";
    BlockSize "block size";
    Dimension "dimension";
    Space "space";
    SpaceDimension "space dimension";
    Sizes "sizes";
    Spacings "spacings";
    Thicknesses "thicknesses";
    AxisMins "axis mins";
    AxisMaxs "axis maxs";
    SpaceDirections "space directions";
    Centers "centers" "centerings";
    Kinds "kinds";
    Labels "labels";
    Units "units";
    Min "min";
    Max "max";
    OldMin "old min";
    OldMax "old max";
    DataFile "data file";
    Endian "endian";
    Encoding "encoding";
    LineSkip "line skip";
    ByteSkip "byte skip";
    SampleUnits "sample units";
    SpaceUnits "space units";
    SpaceOrigin "space origin";
    MeasurementFrame "measurement frame";
}

/// Case and blanks do not matter: `axismins` is as good as `Axis Mins`.
fn plain(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase()
}

impl Field {
    /// The field of this name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        let wanted = plain(name);
        NAMES.iter().find(|(_, name)| plain(name) == wanted).map(|(field, _)| *field)
    }

    /// The usual name.
    pub(super) fn name(self) -> &'static str {
        NAMES.iter().find(|(field, _)| *field == self).map_or("", |(_, name)| name)
    }

    /// The name that an unknown one is a slip of the pen away from.
    pub(super) fn meant_by(name: &str) -> Option<&'static str> {
        let wanted = plain(name);
        NAMES
            .iter()
            .map(|(_, name)| *name)
            .find(|name| wanted.len() >= 4 && strsim::osa_distance(&plain(name), &wanted) == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_in_any_spelling() {
        for (name, field) in [
            ("sizes", Field::Sizes),
            ("Space Origin", Field::SpaceOrigin),
            ("axismins", Field::AxisMins),
            ("datafile", Field::DataFile),
            ("centerings", Field::Centers),
            ("OLD MIN", Field::OldMin),
        ] {
            assert_eq!(Field::from_name(name), Some(field), "{name}");
        }
        assert_eq!(Field::from_name("space orgin"), None);
        assert_eq!(Field::meant_by("space orgin"), Some("space origin"));
        assert_eq!(Field::meant_by("endain"), Some("endian"), "two letters exchanged");
        assert_eq!(Field::meant_by("modality"), None, "a field of somebody's own");
    }
}
