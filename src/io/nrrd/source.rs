//! One data file as a stream of elements: skips, decompression, hexadecimal digits.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use bzip2::bufread::MultiBzDecoder;
use flate2::bufread::MultiGzDecoder;

use super::encoding::Encoding;
use super::header::{ByteSkip, Header};
use crate::error::{Error, Fault, Result};

/// Deflate makes at most 1032 bytes of one (258 bytes from two bits), so a smaller file cannot hold more.
const MOST_BYTES_FROM_ONE: u64 = 1032;

/// A data file, or the data after a header.
#[derive(Debug, Clone)]
pub(super) struct Place {
    /// The file.
    pub(super) path: PathBuf,
    /// Where in it the lines and bytes to skip begin.
    pub(super) start: u64,
}

/// Elements as bytes in the order of memory, or as words.
pub(super) enum Source {
    /// The raw form.
    Bytes(Box<dyn Read>),
    /// Decimal numbers.
    Words(Box<dyn BufRead>),
}

impl Place {
    /// Opens the file before its first element, and checks its size as far as can be without reading it.
    ///
    /// # Errors
    /// `Fault::Input` if the file cannot be opened or is too short, or too long, for `bytes` bytes of elements.
    pub(super) fn open(&self, header: &Header, bytes: u64) -> Result<Source> {
        self.try_open(header, bytes).map_err(|error| match error {
            Refusal::Io(cause) => {
                Error::new(Fault::Input, "the data file cannot be read").at(&self.path).caused_by(cause)
            }
            Refusal::Lines(found) => Error::new(Fault::Input, "the data file ends within the lines to skip")
                .at(&self.path)
                .element("line skip")
                .found(format!("{found} lines"))
                .expected(header.line_skip.to_string()),
            Refusal::Short { found } => short(&self.path, header, found, bytes),
            Refusal::Long { found } => long(&self.path, header, &format!("{found} bytes"), bytes),
        })
    }

    fn try_open(&self, header: &Header, bytes: u64) -> Result<Source, Refusal> {
        let file = File::open(&self.path)?;
        let length = file.metadata()?.len();
        let mut file = BufReader::with_capacity(1 << 16, file);
        file.seek(SeekFrom::Start(self.start))?;
        for line in 0..header.line_skip {
            if file.skip_until(b'\n')? == 0 {
                return Err(Refusal::Lines(line));
            }
        }
        let available = length.saturating_sub(file.stream_position()?);
        let skip = match header.byte_skip {
            ByteSkip::Bytes(skip) => skip,
            ByteSkip::AllButData => available.saturating_sub(bytes),
        };
        Ok(match header.encoding {
            Encoding::Raw => {
                let found = available.saturating_sub(skip);
                if found < bytes {
                    return Err(Refusal::Short { found });
                }
                if found > bytes {
                    return Err(Refusal::Long { found });
                }
                pass(&mut file, skip)?;
                Source::Bytes(Box::new(file))
            }
            Encoding::Gzip => {
                let most = available.saturating_mul(MOST_BYTES_FROM_ONE);
                if most < bytes {
                    return Err(Refusal::Short { found: most });
                }
                let mut file = MultiGzDecoder::new(file);
                pass(&mut file, skip)?;
                Source::Bytes(Box::new(file))
            }
            Encoding::Bzip2 => {
                let mut file = MultiBzDecoder::new(file);
                pass(&mut file, skip)?;
                Source::Bytes(Box::new(file))
            }
            Encoding::Hex => {
                pass(&mut file, skip)?;
                Source::Bytes(Box::new(HexDigits { digits: file }))
            }
            Encoding::Text => {
                pass(&mut file, skip)?;
                Source::Words(Box::new(file))
            }
        })
    }
}

enum Refusal {
    Io(io::Error),
    Lines(u64),
    Short { found: u64 },
    Long { found: u64 },
}

impl From<io::Error> for Refusal {
    fn from(error: io::Error) -> Self {
        Refusal::Io(error)
    }
}

/// Skips bytes.
fn pass(file: &mut impl Read, bytes: u64) -> Result<(), Refusal> {
    let passed = io::copy(&mut file.by_ref().take(bytes), &mut io::sink())?;
    if passed < bytes { Err(Refusal::Short { found: 0 }) } else { Ok(()) }
}

/// The error for a file with too few bytes of elements.
pub(super) fn short(path: &Path, header: &Header, found: u64, expected: u64) -> Error {
    let at_most = if header.encoding == Encoding::Gzip { "at most " } else { "" };
    Error::new(Fault::Input, "the data ends too early")
        .at(path)
        .found(format!("{at_most}{found} bytes of elements"))
        .expected(format!("{expected} for {} of {}", header.shape(), header.element_type.name()))
        .remedy("copy or export the file again; it is likely to be cut off")
}

/// The error for a file with more than the elements.
pub(super) fn long(path: &Path, header: &Header, found: &str, expected: u64) -> Error {
    Error::new(Fault::Input, "there is more data than elements")
        .at(path)
        .found(found)
        .expected(format!("{expected} bytes for {} of {}", header.shape(), header.element_type.name()))
        .remedy("correct `sizes` and `type`, or say with `line skip` and `byte skip` where the elements begin")
}

/// Pairs of hexadecimal digits as bytes; white space does not matter.
struct HexDigits<R> {
    digits: R,
}

impl<R: BufRead> HexDigits<R> {
    fn next(&mut self) -> io::Result<Option<u8>> {
        loop {
            let Some(&byte) = self.digits.fill_buf()?.first() else { return Ok(None) };
            self.digits.consume(1);
            if !byte.is_ascii_whitespace() {
                let digit = char::from(byte).to_digit(16).ok_or_else(|| {
                    io::Error::new(
                        io::ErrorKind::InvalidData,
                        format!("{:?} is no hexadecimal digit", char::from(byte)),
                    )
                })?;
                return Ok(u8::try_from(digit).ok());
            }
        }
    }
}

impl<R: BufRead> Read for HexDigits<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        for (count, byte) in buffer.iter_mut().enumerate() {
            let Some(high) = self.next()? else { return Ok(count) };
            let low = self.next()?.ok_or_else(|| {
                io::Error::new(io::ErrorKind::InvalidData, "the hexadecimal digits end within a byte")
            })?;
            *byte = high << 4 | low;
        }
        Ok(buffer.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_digits_come_in_pairs() {
        let read = |text: &'static str| {
            let mut bytes = Vec::new();
            HexDigits { digits: text.as_bytes() }.read_to_end(&mut bytes).map(|_| bytes).map_err(|e| e.to_string())
        };
        assert_eq!(read(" 00 fF\n1\n2"), Ok(vec![0, 255, 0x12]));
        assert_eq!(read("0"), Err("the hexadecimal digits end within a byte".to_owned()));
        assert_eq!(read("0g"), Err("'g' is no hexadecimal digit".to_owned()));
    }
}
