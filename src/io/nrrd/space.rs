//! World spaces by name, and their map to LPS.

use glam::DVec3;

/// Orientation of the world axes x, y and z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Frame {
    /// x to the right, y to the front, z to the head.
    RightAnteriorSuperior,
    /// x to the left, y to the front, z to the head.
    LeftAnteriorSuperior,
    /// x to the left, y to the back, z to the head: DICOM's patient coordinates.
    LeftPosteriorSuperior,
    /// Axes of the scanner (ACR-NEMA 2.0); how the patient lay in it is not said.
    ScannerXyz,
    /// Any right-handed axes.
    RightHanded,
    /// Any left-handed axes.
    LeftHanded,
}

/// A world space (field `space`), with or without time as its last coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Space {
    /// The spatial axes.
    pub frame: Frame,
    /// True if time follows them.
    pub time: bool,
}

const FRAMES: &[(Frame, &str, &str)] = &[
    (Frame::RightAnteriorSuperior, "right-anterior-superior", "RAS"),
    (Frame::LeftAnteriorSuperior, "left-anterior-superior", "LAS"),
    (Frame::LeftPosteriorSuperior, "left-posterior-superior", "LPS"),
    (Frame::ScannerXyz, "scanner-xyz", ""),
    (Frame::RightHanded, "3D-right-handed", ""),
    (Frame::LeftHanded, "3D-left-handed", ""),
];

impl Space {
    /// The space of this name or abbreviation, in any case, with hyphens, blanks or nothing between the words.
    pub fn from_name(name: &str) -> Option<Self> {
        let plain = |s: &str| s.chars().filter(|c| !matches!(c, '-' | ' ' | '_')).collect::<String>().to_lowercase();
        let wanted = plain(name);
        FRAMES.iter().find_map(|&(frame, long, short)| {
            let (long, short) = (plain(long), plain(short));
            let space = |time| Some(Space { frame, time });
            match wanted.as_str() {
                "" => None,
                w if w == long || w == short => space(false),
                w if w == format!("{long}time") || (!short.is_empty() && w == format!("{short}t")) => space(true),
                _ => None,
            }
        })
    }

    /// The full name, as in files.
    pub fn name(self) -> String {
        let long = FRAMES.iter().find(|(frame, ..)| *frame == self.frame).map_or("", |(_, long, _)| long);
        if self.time { format!("{long}-time") } else { long.to_owned() }
    }

    /// Number of world coordinates.
    pub fn dimension(self) -> usize {
        if self.time { 4 } else { 3 }
    }

    /// Sign of each world axis in LPS.
    ///
    /// A left-handed frame can only become LPS, which is right-handed, by reversing an axis. The frame of axial
    /// slices as they are shown (columns to the left, rows to the back) and counted from the head down is
    /// left-handed, so z is the one: a patient is then never shown with left and right exchanged.
    pub fn signs_to_lps(self) -> DVec3 {
        match self.frame {
            Frame::RightAnteriorSuperior => DVec3::new(-1.0, -1.0, 1.0),
            Frame::LeftAnteriorSuperior => DVec3::new(1.0, -1.0, 1.0),
            Frame::LeftPosteriorSuperior | Frame::ScannerXyz | Frame::RightHanded => DVec3::ONE,
            Frame::LeftHanded => DVec3::new(1.0, 1.0, -1.0),
        }
    }

    /// What is assumed about the patient, where the space does not name their axes.
    pub fn assumption(self) -> Option<&'static str> {
        match self.frame {
            Frame::ScannerXyz | Frame::RightHanded => {
                Some("x is assumed to go to the patient's left, y to the back, z to the head")
            }
            Frame::LeftHanded => Some("x is assumed to go to the patient's left, y to the back, z to the feet"),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_abbreviations_are_found() {
        let found = |name: &str| Space::from_name(name).map(Space::name).unwrap_or_default();
        for (name, full) in [
            ("RAS", "right-anterior-superior"),
            ("left posterior superior", "left-posterior-superior"),
            ("LeftAnteriorSuperior", "left-anterior-superior"),
            ("lpst", "left-posterior-superior-time"),
            ("LAST", "left-anterior-superior-time"),
            ("right-anterior-superior-time", "right-anterior-superior-time"),
            ("scanner-xyz-time", "scanner-xyz-time"),
            ("3D-left-handed", "3D-left-handed"),
            ("3d right handed time", "3D-right-handed-time"),
        ] {
            assert_eq!(found(name), full, "{name}");
        }
        for name in ["", "t", "time", "RPS", "lp"] {
            assert_eq!(found(name), "", "{name:?} is no space");
        }
    }

    #[test]
    fn every_frame_keeps_its_handedness() {
        for (frame, left_handed) in [
            (Frame::RightAnteriorSuperior, false),
            (Frame::LeftAnteriorSuperior, true),
            (Frame::LeftPosteriorSuperior, false),
            (Frame::RightHanded, false),
            (Frame::LeftHanded, true),
        ] {
            let s = Space { frame, time: false }.signs_to_lps();
            assert_eq!(s.x * s.y * s.z < 0.0, left_handed, "{frame:?} has signs {s:?}");
        }
    }
}
