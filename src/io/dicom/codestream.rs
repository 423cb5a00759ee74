//! What a compressed frame says about itself.
//!
//! The header of the frame and the data set around it may disagree: a width, a precision, a sign (a JPEG 2000 codestream
//! has one of its own). The decoders copy the samples without a look at either, so the frame's header is read here first:
//! SIZ of JPEG 2000 (ISO/IEC 15444-1 §A.5.1), SOF, DRI and SOS of JPEG (ITU-T T.81 §B.2).

/// Start of a JPEG 2000 codestream: SOC, then SIZ; it may lie inside a JP2 file.
const J2K_START: [u8; 4] = [0xFF, 0x4F, 0xFF, 0x51];

/// The header of a compressed frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Codestream {
    pub(super) coding: Coding,
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) components: usize,
    /// Bits of a sample.
    pub(super) precision: u32,
}

/// How the samples are coded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Coding {
    /// JPEG 2000, whose samples are signed or not.
    Jpeg2000 { signed: bool },
    /// JPEG by discrete cosine transform: baseline, extended, progressive.
    JpegDct,
    /// JPEG lossless, process 14 (T.81 annex H).
    JpegLossless {
        /// Samples between restart markers, 0 for none.
        restart_interval: u16,
        /// Low bits left out.
        point_transform: u8,
    },
}

impl Codestream {
    /// The header of a JPEG 2000 frame, if that is what the bytes are.
    pub(super) fn of_jpeg2000(bytes: &[u8]) -> Option<Self> {
        let start = bytes.windows(4).position(|window| window == J2K_START)? + J2K_START.len();
        // Lsiz, Rsiz, then Xsiz, Ysiz, XOsiz, YOsiz, four numbers of the tiles, Csiz, and Ssiz of the first component.
        let siz = bytes.get(start..)?;
        let word = |at: usize| siz.get(at..at + 4).and_then(|b| <[u8; 4]>::try_from(b).ok()).map(u32::from_be_bytes);
        let size = |far: usize, near: usize| Some(word(far)?.checked_sub(word(near)?)? as usize);
        let sample = *siz.get(38)?;
        Some(Codestream {
            coding: Coding::Jpeg2000 { signed: sample & 0x80 != 0 },
            columns: size(4, 12)?,
            rows: size(8, 16)?,
            components: usize::from(u16::from_be_bytes([*siz.get(36)?, *siz.get(37)?])),
            precision: u32::from(sample & 0x7F) + 1,
        })
    }

    /// The header of a JPEG frame, if that is what the bytes are.
    pub(super) fn of_jpeg(bytes: &[u8]) -> Option<Self> {
        let mut at = 2;
        let mut restart_interval = 0;
        let mut frame: Option<(u8, [u8; 6])> = None;
        if bytes.get(..2)? != [0xFF, 0xD8] {
            return None;
        }
        loop {
            if *bytes.get(at)? != 0xFF {
                return None;
            }
            let marker = *bytes.get(at + 1)?;
            if marker == 0xFF {
                at += 1; // A fill byte (§B.1.1.2).
                continue;
            }
            let length = usize::from(u16::from_be_bytes([*bytes.get(at + 2)?, *bytes.get(at + 3)?]));
            let segment = bytes.get(at + 4..at + 2 + length)?;
            match marker {
                0xDD => restart_interval = u16::from_be_bytes([*segment.first()?, *segment.get(1)?]),
                // SOF0 to SOF15, among which DHT, JPG and DAC have their numbers too.
                0xC0..=0xCF if !matches!(marker, 0xC4 | 0xC8 | 0xCC) => {
                    frame = Some((marker, segment.get(..6)?.try_into().ok()?));
                }
                0xDA => {
                    let (sof, [precision, y1, y0, x1, x0, components]) = frame?;
                    let coding = if sof == 0xC3 {
                        Coding::JpegLossless { restart_interval, point_transform: segment.last()? & 0x0F }
                    } else {
                        Coding::JpegDct
                    };
                    return Some(Codestream {
                        coding,
                        rows: usize::from(u16::from_be_bytes([y1, y0])),
                        columns: usize::from(u16::from_be_bytes([x1, x0])),
                        components: usize::from(components),
                        precision: u32::from(precision),
                    });
                }
                _ => {}
            }
            at += 2 + length;
        }
    }

    /// The clause that says why the decoder at hand would get these samples wrong, if so.
    pub(super) fn refusal(&self) -> Option<String> {
        match self.coding {
            Coding::JpegDct if self.precision != 8 => {
                Some(format!("JPEG of {} bits by cosine transform is not decoded; 8 bits are", self.precision))
            }
            // At a restart the prediction starts anew (§H.1.2.1); jpeg-decoder 0.3 goes on from the left neighbour.
            Coding::JpegLossless { restart_interval: 1.., .. } => {
                Some("lossless JPEG with restart intervals is not decoded".to_owned())
            }
            Coding::JpegLossless { point_transform: 1.., .. } => {
                Some("lossless JPEG with a point transform is not decoded".to_owned())
            }
            _ => None,
        }
    }

    /// Bytes that the decoder gives for one sample; two wherever the data set says so, except for 8-bit JPEG.
    pub(super) fn decoded_sample_bytes(&self, bits_allocated: i64) -> usize {
        match self.coding {
            Coding::Jpeg2000 { .. } => {
                if bits_allocated == 8 {
                    1
                } else {
                    2
                }
            }
            Coding::JpegDct | Coding::JpegLossless { .. } => {
                if self.precision == 8 {
                    1
                } else {
                    2
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn siz_of_jpeg_2000_is_read() {
        let mut bytes = vec![0xFF, 0x4F, 0xFF, 0x51, 0, 41, 0, 0];
        for n in [20_u32, 14, 4, 2, 20, 14, 0, 0] {
            bytes.extend(n.to_be_bytes());
        }
        bytes.extend([0, 1, 0x80 | 12, 1, 1]);
        let found = Codestream::of_jpeg2000(&bytes);
        let expected = Codestream {
            coding: Coding::Jpeg2000 { signed: true },
            rows: 12,
            columns: 16,
            components: 1,
            precision: 13,
        };
        assert_eq!(found, Some(expected), "16 x 12, signed, 13 bits");
        assert_eq!(Codestream::of_jpeg2000(&bytes[..30]), None, "cut off");
    }

    #[test]
    fn frame_scan_and_restart_of_jpeg_are_read() {
        let bytes = [
            0xFF, 0xD8, 0xFF, 0xDD, 0, 4, 0, 9, 0xFF, 0xFF, 0xC3, 0, 11, 16, 0, 5, 0, 7, 1, 1, 0x11, 0, 0xFF, 0xDA, 0,
            8, 1, 1, 0, 1, 0, 0x02,
        ];
        let found = Codestream::of_jpeg(&bytes).unwrap();
        let coding = Coding::JpegLossless { restart_interval: 9, point_transform: 2 };
        let expected = Codestream { coding, rows: 5, columns: 7, components: 1, precision: 16 };
        assert_eq!(found, expected, "lossless, 16 bits, 7 x 5");
        assert!(found.refusal().is_some(), "restarts are refused");
        assert_eq!(Codestream::of_jpeg(&bytes[..20]), None, "cut off");
        assert_eq!(Codestream::of_jpeg(b"no JPEG"), None);
    }
}
