//! Reads the elements of an array, from one file or many.
//!
//! Memory follows the data: what a header declares is allocated at once only where the size of the files proves it, and
//! otherwise grows with what has been read, never past what was declared.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use super::elements::{Element, Elements, with_elements};
use super::encoding::{ElementType, Encoding, Endian};
use super::header::Header;
use super::source::{Place, Source, long, short};
use super::{Array, parse};
use crate::error::{Error, Fault, Result};
use crate::io::FileFate;

/// Longest header that is read; the largest known ones, of segmentations, have a few hundred kilobytes.
const MAX_HEADER_BYTES: usize = 16 << 20;
/// Longest decimal number that is read.
const MAX_WORD_BYTES: usize = 512;
/// Bytes that are read at once; a multiple of every element's size.
const CHUNK_BYTES: usize = 1 << 16;

/// Reads a header; gives warnings, and the position after the blank line.
pub(super) fn header(path: &Path) -> Result<(Header, Vec<String>, u64)> {
    let unreadable = |cause: io::Error| Error::new(Fault::Input, "the file cannot be read").at(path).caused_by(cause);
    let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
    let mut text = Vec::new();
    let start = file.fill_buf().map_err(unreadable)?;
    if !start.starts_with(b"NRRD") {
        let start = String::from_utf8_lossy(&start[..start.len().min(64)]).into_owned();
        return parse::header(path, start).map(|(header, warnings)| (header, warnings, 0));
    }
    loop {
        let start = text.len();
        let room = (MAX_HEADER_BYTES - start) as u64;
        file.by_ref().take(room).read_until(b'\n', &mut text).map_err(unreadable)?;
        if text.len() == MAX_HEADER_BYTES {
            return Err(Error::new(Fault::Input, "the header does not end")
                .at(path)
                .found(format!("no blank line in {MAX_HEADER_BYTES} bytes")));
        }
        let blank = matches!(&text[start..], b"\n" | b"\r\n");
        if blank || text.len() == start {
            let end = text.len() as u64;
            text.truncate(start);
            let (header, warnings) = parse::header(path, String::from_utf8_lossy(&text).into_owned())?;
            return Ok((header, warnings, end));
        }
    }
}

/// Bytes that one byte of deflated data stands for at most (zlib's technical details).
const MOST_INFLATED: u64 = 1032;

/// Most bytes held while the elements become samples, estimated: the elements, and 16-bit samples beside those of
/// another size.
pub(super) fn most_bytes(header: &Header) -> u64 {
    let count = header.element_count().map_or(u64::MAX, |n| n as u64);
    let element = header.element_type.bytes() as u64;
    let beside =
        if matches!(header.element_type, ElementType::F32 | ElementType::I16 | ElementType::U16) { 0 } else { 2 };
    count.saturating_mul(element + beside)
}

/// Reads a header and all elements.
pub(super) fn array(path: &Path, max_bytes: Option<u64>) -> Result<Array> {
    let (header, warnings, data_start) = header(path)?;
    if let Some(most) = max_bytes.filter(|&most| most_bytes(&header) > most) {
        return Err(Error::new(Fault::Limit, "the volume does not fit into memory")
            .at(path)
            .element(format!("{} of {}", header.shape(), header.element_type.name()))
            .found(format!("{} bytes", most_bytes(&header)))
            .expected(format!("at most {most} bytes"))
            .remedy("crop the volume, or raise the limit on memory with --max-memory"));
    }
    let sizes: Vec<usize> = header.axes.iter().map(|axis| axis.size).collect();
    let count = header.element_count()?;
    let division = header.data_file.division(&sizes, count).map_err(|error| error.at(path))?;
    let place = |index| match header.data_file.name(index) {
        None => Place { path: path.to_path_buf(), start: data_start },
        Some(name) => Place { path: path.with_file_name(&name), start: 0 },
    };

    let piece = Piece { header: &header, elements: division.elements, total: count };
    let mut elements = Elements::none_of(header.element_type);
    if header.encoding == Encoding::Raw {
        // Every file is there and has its exact size before memory is taken for all of them.
        (0..division.files).try_for_each(|index| place(index).open(&header, piece.bytes()).map(drop))?;
        with_elements!(&mut elements, values => make_room(values, count, count))?;
    } else if header.encoding == Encoding::Gzip {
        let compressed = |index| std::fs::metadata(place(index).path).map_or(0, |file| file.len());
        let most = (0..division.files).map(compressed).sum::<u64>().saturating_mul(MOST_INFLATED);
        // A vector that grows holds itself twice for a while; this one need not, if the files can hold what they claim.
        if most >= (count * header.element_type.bytes()) as u64 {
            with_elements!(&mut elements, values => make_room(values, count, count))?;
        }
    }
    for index in 0..division.files {
        let place = place(index);
        let source = place.open(&header, piece.bytes())?;
        with_elements!(&mut elements, values => piece.read(&place.path, source, values))?;
    }
    Ok(Array { files: fates(path, &header, division.files, place), header, elements, warnings })
}

/// What became of the header and of the files it names.
fn fates(path: &Path, header: &Header, files: usize, place: impl Fn(usize) -> Place) -> Vec<FileFate> {
    let fate = |path: &Path, reason: &str| FileFate { path: path.to_path_buf(), used: true, reason: reason.to_owned() };
    if header.data_file.name(0).is_none() {
        return vec![fate(path, "header and data")];
    }
    let data = (0..files).map(|index| fate(&place(index).path, "data"));
    std::iter::once(fate(path, "header")).chain(data).collect()
}

/// Makes room for `more` elements, but for no more than `total` in all.
fn make_room<T>(values: &mut Vec<T>, more: usize, total: usize) -> Result<()> {
    let needed = values.len().saturating_add(more).min(total);
    if needed > values.capacity() {
        let capacity = values.capacity().saturating_mul(2).max(needed).min(total);
        values.try_reserve_exact(capacity - values.len()).map_err(|cause| {
            Error::new(Fault::Limit, "there is not enough memory for the volume")
                .found(format!("{total} elements of {} bytes", size_of::<T>()))
                .caused_by(cause)
        })?;
    }
    Ok(())
}

/// What one file holds.
struct Piece<'a> {
    header: &'a Header,
    /// Elements in this file.
    elements: usize,
    /// Elements in all files.
    total: usize,
}

impl Piece<'_> {
    fn bytes(&self) -> u64 {
        // Cannot overflow: the bytes of all elements were counted when the header was read.
        (self.elements * self.header.element_type.bytes()) as u64
    }

    fn read<T: Element>(&self, path: &Path, source: Source, values: &mut Vec<T>) -> Result<()> {
        match source {
            Source::Bytes(bytes) => self.read_bytes(path, bytes, values),
            Source::Words(words) => self.read_words(path, words, values),
        }
    }

    fn read_bytes<T: Element>(&self, path: &Path, mut source: impl Read, values: &mut Vec<T>) -> Result<()> {
        // One byte has no order.
        let endian = self.header.endian.unwrap_or(Endian::Little);
        let mut chunk = vec![0; CHUNK_BYTES];
        let mut left = self.bytes();
        while left > 0 {
            let wanted = left.min(CHUNK_BYTES as u64) as usize;
            let found = fill(&mut source, &mut chunk[..wanted]).map_err(|cause| {
                // What the decoder still held back is not counted.
                self.damaged(path, cause).found(format!("at least {} bytes of elements", self.bytes() - left))
            })?;
            if found < wanted {
                return Err(short(path, self.header, self.bytes() - left + found as u64, self.bytes()));
            }
            make_room(values, wanted / T::BYTES, self.total).map_err(|error| error.at(path))?;
            values.extend(chunk[..wanted].chunks_exact(T::BYTES).map(|bytes| T::from_bytes(bytes, endian)));
            left -= wanted as u64;
        }
        match fill(&mut source, &mut chunk[..1]) {
            Ok(0) => Ok(()),
            Ok(_) => Err(long(path, self.header, &format!("more than {} bytes", self.bytes()), self.bytes())),
            Err(cause) => Err(self.damaged(path, cause).found("something else after the elements")),
        }
    }

    fn read_words<T: Element>(&self, path: &Path, mut source: impl BufRead, values: &mut Vec<T>) -> Result<()> {
        let mut word = String::new();
        let mut read = 0;
        while next_word(&mut source, &mut word).map_err(|cause| self.damaged(path, cause))? {
            let name = self.header.element_type.name();
            if read == self.elements {
                return Err(Error::new(Fault::Input, "there are more numbers than elements")
                    .at(path)
                    .found(format!("`{word}` after the last"))
                    .expected(format!("{} numbers for {} of {name}", self.elements, self.header.shape())));
            }
            let value = T::from_text(&word).ok_or_else(|| {
                Error::new(Fault::Input, "a number cannot be read")
                    .at(path)
                    .element(format!("number {}", read + 1))
                    .found(format!("`{word}`"))
                    .expected(name)
            })?;
            make_room(values, 1, self.total).map_err(|error| error.at(path))?;
            values.push(value);
            read += 1;
        }
        if read < self.elements {
            return Err(Error::new(Fault::Input, "the data ends too early")
                .at(path)
                .found(format!("{read} numbers"))
                .expected(format!("{} for {}", self.elements, self.header.shape())));
        }
        Ok(())
    }

    /// The error for a stream that cannot be decoded.
    fn damaged(&self, path: &Path, cause: io::Error) -> Error {
        Error::new(Fault::Input, format!("the {} data is damaged or cut off", self.header.encoding.name()))
            .at(path)
            .expected(format!("{} bytes for {}", self.bytes(), self.header.shape()))
            .caused_by(cause)
            .remedy("copy or export the file again")
    }
}

/// Reads until the buffer is full or the stream ends; gives the number of bytes.
fn fill(source: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match source.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

/// Reads the next word between white space or commas; false at the end.
fn next_word(source: &mut impl BufRead, word: &mut String) -> io::Result<bool> {
    let separates = |b: &u8| b.is_ascii_whitespace() || *b == b',';
    word.clear();
    loop {
        let buffer = source.fill_buf()?;
        if buffer.is_empty() {
            return Ok(!word.is_empty());
        }
        let skipped = if word.is_empty() { buffer.iter().take_while(|b| separates(b)).count() } else { 0 };
        let rest = &buffer[skipped..];
        let length = rest.iter().position(separates).unwrap_or(rest.len());
        let text = std::str::from_utf8(&rest[..length]).ok().filter(|text| text.is_ascii());
        let fits = word.len() + length <= MAX_WORD_BYTES;
        let Some(text) = text.filter(|_| fits) else {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "this is no text of numbers"));
        };
        word.push_str(text);
        let ended = length < rest.len() && !word.is_empty();
        source.consume(skipped + length);
        if ended {
            return Ok(true);
        }
    }
}
