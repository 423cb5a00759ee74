//! From the lines of a header to what they mean.

use std::path::Path;

use super::data_file::{DataFile, NumberedName};
use super::encoding::{ElementType, Encoding, Endian};
use super::field::Field;
use super::header::{Axis, ByteSkip, Center, Header};
use super::kind::Kind;
use super::lines::{Entry, Lines, clip, is_list};
use super::space::Space;
use super::values;
use crate::error::{Error, Fault, Result};

/// Most axes that the format allows (`NRRD_DIM_MAX` of teem).
const MAX_DIMENSION: usize = 16;

/// Reads the text of a header, without the blank line that ends it; gives the header and warnings.
pub(super) fn header(path: &Path, text: String) -> Result<(Header, Vec<String>)> {
    let mut parser = Parser { lines: Lines::parse(path, text)? };
    let header = parser.header()?;
    header.element_count().map_err(|error| error.at(path))?;
    Ok((header, parser.lines.warnings))
}

struct Parser {
    lines: Lines,
}

impl Parser {
    fn header(&mut self) -> Result<Header> {
        let element_type = self.element_type()?;
        let encoding = self.encoding()?;
        let dimension = self.dimension()?;
        let (space, space_dimension) = self.space()?;
        let header = Header {
            version: self.lines.version,
            element_type,
            encoding,
            endian: self.endian(element_type, encoding)?,
            axes: self.axes(dimension, space_dimension)?,
            space,
            space_dimension,
            space_units: self
                .optional(Field::SpaceUnits, "names in double quotes", values::strings)?
                .unwrap_or_default(),
            space_origin: self.origin(space_dimension)?,
            measurement_frame: self.measurement_frame(space_dimension)?,
            content: self.lines.get(Field::Content).map(|entry| entry.value.clone()),
            sample_units: self.lines.get(Field::SampleUnits).map(|entry| entry.value.clone()),
            value_range: [self.number(Field::Min)?, self.number(Field::Max)?],
            old_range: [self.number(Field::OldMin)?, self.number(Field::OldMax)?],
            data_file: self.data_file()?,
            line_skip: self.optional(Field::LineSkip, "a number of lines", |v| v.parse().ok())?.unwrap_or(0),
            byte_skip: self.byte_skip(encoding)?,
            key_values: std::mem::take(&mut self.lines.key_values),
            comments: std::mem::take(&mut self.lines.comments),
        };
        Ok(header)
    }

    fn wrong(&self, field: Field, entry: &Entry, expected: impl Into<String>) -> Error {
        self.lines
            .error(Fault::Input, "a field cannot be read", entry)
            .element(field.name())
            .found(format!("`{}`", clip(&entry.value)))
            .expected(expected)
    }

    /// Reads a field if the header has it.
    fn optional<T>(&self, field: Field, expected: &str, read: impl Fn(&str) -> Option<T>) -> Result<Option<T>> {
        let Some(entry) = self.lines.get(field) else { return Ok(None) };
        read(&entry.value).map(Some).ok_or_else(|| self.wrong(field, entry, expected))
    }

    fn number(&self, field: Field) -> Result<Option<f64>> {
        let one = |v: &str| values::numbers(v).filter(|n| n.len() == 1).map(|n| n[0]);
        Ok(self.optional(field, "one number", one)?.flatten())
    }

    fn element_type(&self) -> Result<ElementType> {
        let entry = self.lines.require(Field::Type)?;
        ElementType::from_name(&entry.value).ok_or_else(|| match entry.value.to_lowercase().as_str() {
            "block" => self
                .lines
                .error(Fault::Unsupported, "elements that are blocks of bytes cannot be rendered", entry)
                .element("type"),
            "char" => self
                .wrong(Field::Type, entry, "`signed char` or `unsigned char`")
                .remedy("say which: the sign of a plain `char` differs between machines"),
            _ => self.wrong(Field::Type, entry, "a type such as `short`, `uint8` or `float`"),
        })
    }

    fn encoding(&self) -> Result<Encoding> {
        let entry = self.lines.require(Field::Encoding)?;
        Encoding::from_name(&entry.value).ok_or_else(|| {
            self.lines
                .error(Fault::Unsupported, "the encoding is not known", entry)
                .element("encoding")
                .found(format!("`{}`", clip(&entry.value)))
                .expected("raw, gzip, bzip2, ascii or hex")
        })
    }

    fn endian(&self, element_type: ElementType, encoding: Encoding) -> Result<Option<Endian>> {
        let endian = self.optional(Field::Endian, "`little` or `big`", Endian::from_name)?;
        if endian.is_none() && element_type.bytes() > 1 && encoding.shows_byte_order() {
            self.lines.require(Field::Endian)?;
        }
        Ok(endian)
    }

    fn dimension(&self) -> Result<usize> {
        let entry = self.lines.require(Field::Dimension)?;
        let dimension = entry.value.parse().ok().filter(|n| (1..=MAX_DIMENSION).contains(n));
        dimension.ok_or_else(|| self.wrong(Field::Dimension, entry, format!("a number from 1 to {MAX_DIMENSION}")))
    }

    fn space(&self) -> Result<(Option<Space>, Option<usize>)> {
        let name = "left-posterior-superior or another space of the format's definition";
        let space = self.optional(Field::Space, name, Space::from_name)?;
        let counted = |v: &str| v.parse().ok().filter(|n| (1..=MAX_DIMENSION).contains(n));
        let dimension = self.optional(Field::SpaceDimension, "a number from 1 to 16", counted)?;
        match (space, dimension, self.lines.get(Field::SpaceDimension)) {
            (Some(space), Some(found), Some(entry)) if found != space.dimension() => {
                Err(self.wrong(Field::SpaceDimension, entry, format!("{} for {}", space.dimension(), space.name())))
            }
            _ => Ok((space, space.map(Space::dimension).or(dimension))),
        }
    }

    /// Reads a field with one entry for each axis.
    fn per_axis<T>(
        &self,
        field: Field,
        dimension: usize,
        expected: &str,
        read: impl Fn(&str) -> Option<Vec<T>>,
    ) -> Result<Vec<Option<T>>> {
        let Some(entry) = self.lines.get(field) else { return Ok((0..dimension).map(|_| None).collect()) };
        match read(&entry.value) {
            Some(found) if found.len() == dimension => Ok(found.into_iter().map(Some).collect()),
            Some(found) => Err(self.wrong(field, entry, format!("{dimension}, one for each axis")).found(format!(
                "{} in `{}`",
                found.len(),
                clip(&entry.value)
            ))),
            None => Err(self.wrong(field, entry, format!("{dimension} {expected}"))),
        }
    }

    fn axes(&self, dimension: usize, space_dimension: Option<usize>) -> Result<Vec<Axis>> {
        let words = |v: &str| Some(v.split_whitespace().map(str::to_owned).collect::<Vec<_>>());
        self.lines.require(Field::Sizes)?;
        let size = |w: &str| w.parse::<usize>().ok().filter(|&n| n > 0);
        let sizes = self
            .per_axis(Field::Sizes, dimension, "whole numbers above 0", |v| v.split_whitespace().map(size).collect())?;
        let number = |field| self.per_axis(field, dimension, "numbers or `nan`", values::numbers);
        let (spacings, thicknesses) = (number(Field::Spacings)?, number(Field::Thicknesses)?);
        let (mins, maxs) = (number(Field::AxisMins)?, number(Field::AxisMaxs)?);
        let centers = self.per_axis(Field::Centers, dimension, "of `cell`, `node` or `???`", |v| {
            v.split_whitespace().map(center).collect()
        })?;
        let kinds = self.per_axis(Field::Kinds, dimension, "names of kinds", words)?;
        let directions = self.directions(dimension, space_dimension)?;
        let labels = self.per_axis(Field::Labels, dimension, "names in double quotes", values::strings)?;
        let units = self.per_axis(Field::Units, dimension, "names in double quotes", values::strings)?;
        (0..dimension)
            .map(|i| {
                Ok(Axis {
                    size: sizes[i].unwrap_or(0),
                    spacing: spacings[i].flatten(),
                    thickness: thicknesses[i].flatten(),
                    min: mins[i].flatten(),
                    max: maxs[i].flatten(),
                    center: centers[i].flatten(),
                    kind: self.kind(kinds[i].as_deref(), sizes[i].unwrap_or(0))?,
                    direction: directions[i].clone().flatten(),
                    label: labels[i].clone().filter(|s| !s.is_empty()),
                    unit: units[i].clone().filter(|s| !s.is_empty()),
                })
            })
            .collect()
    }

    fn kind(&self, name: Option<&str>, size: usize) -> Result<Option<Kind>> {
        let (Some(name), Some(entry)) = (name, self.lines.get(Field::Kinds)) else { return Ok(None) };
        if name == "???" || name.eq_ignore_ascii_case("none") {
            return Ok(None);
        }
        let kind = Kind::from_name(name).ok_or_else(|| {
            self.wrong(Field::Kinds, entry, "kinds such as `domain`, `list` or `RGBA-color`")
                .found(format!("`{}`", clip(name)))
        })?;
        match kind.size() {
            Some(expected) if expected != size => Err(self
                .wrong(Field::Kinds, entry, format!("an axis of {expected}"))
                .found(format!("`{}` for an axis of {size}", kind.name()))),
            _ => Ok(Some(kind)),
        }
    }

    /// Reads vectors of the world, which need to know how many coordinates it has.
    fn world_vectors(&self, field: Field, space_dimension: Option<usize>) -> Result<Option<Vec<Option<Vec<f64>>>>> {
        let Some(entry) = self.lines.get(field) else { return Ok(None) };
        let Some(dimension) = space_dimension else {
            return Err(self
                .lines
                .error(Fault::Input, "a vector is given in a space that is not", entry)
                .element(field.name())
                .expected("`space` or `space dimension` in the same header"));
        };
        let found = values::vectors(&entry.value);
        let fits = |v: &Vec<Option<Vec<f64>>>| v.iter().flatten().all(|v| v.len() == dimension);
        let expected = format!("vectors of {dimension} finite numbers, such as `(1,0,0)`, or `none`");
        found.filter(fits).map(Some).ok_or_else(|| self.wrong(field, entry, expected))
    }

    fn directions(&self, dimension: usize, space_dimension: Option<usize>) -> Result<Vec<Option<Option<Vec<f64>>>>> {
        let found = self.world_vectors(Field::SpaceDirections, space_dimension)?;
        self.per_axis(Field::SpaceDirections, dimension, "vectors", |_| found.clone())
    }

    fn origin(&self, space_dimension: Option<usize>) -> Result<Option<Vec<f64>>> {
        let found = self.world_vectors(Field::SpaceOrigin, space_dimension)?;
        match (found.as_deref(), self.lines.get(Field::SpaceOrigin)) {
            (Some([one]), _) => Ok(one.clone()),
            (Some(_), Some(entry)) => Err(self.wrong(Field::SpaceOrigin, entry, "one vector")),
            _ => Ok(None),
        }
    }

    fn measurement_frame(&self, space_dimension: Option<usize>) -> Result<Option<Vec<Vec<f64>>>> {
        let found = self.world_vectors(Field::MeasurementFrame, space_dimension)?;
        let columns: Option<Vec<Vec<f64>>> = found.map(|v| v.into_iter().flatten().collect());
        match (columns, self.lines.get(Field::MeasurementFrame)) {
            (Some(columns), Some(entry)) if Some(columns.len()) != space_dimension => {
                Err(self.wrong(Field::MeasurementFrame, entry, "one vector for each coordinate of the space"))
            }
            (columns, _) => Ok(columns),
        }
    }

    fn byte_skip(&self, encoding: Encoding) -> Result<ByteSkip> {
        let read = |v: &str| match v {
            "-1" => Some(ByteSkip::AllButData),
            _ => v.parse().ok().map(ByteSkip::Bytes),
        };
        let skip = self.optional(Field::ByteSkip, "a number of bytes, or -1", read)?.unwrap_or(ByteSkip::Bytes(0));
        match self.lines.get(Field::ByteSkip) {
            Some(entry) if skip == ByteSkip::AllButData && encoding != Encoding::Raw => Err(self
                .wrong(Field::ByteSkip, entry, "a number of bytes: only in raw files do the elements have a known size")
                .found(format!("-1 with encoding {}", encoding.name()))),
            _ => Ok(skip),
        }
    }

    fn data_file(&mut self) -> Result<DataFile> {
        let Some(entry) = self.lines.get(Field::DataFile).cloned() else { return Ok(DataFile::Attached) };
        let wrong = |expected| Err(self.wrong(Field::DataFile, &entry, expected));
        if entry.value.is_empty() {
            return wrong("the name of a file");
        }
        if is_list(&entry.value) {
            let subdimension = match entry.value.split_whitespace().nth(1).map(str::parse) {
                None => None,
                Some(Ok(n)) if (1..=MAX_DIMENSION).contains(&n) => Some(n),
                Some(_) => return wrong("a number of axes from 1 after LIST"),
            };
            return Ok(DataFile::List { names: std::mem::take(&mut self.lines.listed_files), subdimension });
        }
        let Some((name, numbers)) = numbered_files(&entry.value) else { return Ok(DataFile::Single(entry.value)) };
        let &[first, last, step, ref subdimension @ ..] = numbers.as_slice() else {
            return Ok(DataFile::Single(entry.value));
        };
        let subdimension = match subdimension {
            [] => None,
            [n] => Some(usize::try_from(*n).ok().filter(|n| (1..=MAX_DIMENSION).contains(n))),
            _ => Some(None),
        };
        match subdimension {
            Some(None) => wrong("`name%d first last step` and possibly a number of axes from 1"),
            _ if step == 0 => wrong("a step other than 0"),
            _ if (step > 0) != (last > first) && last != first => wrong("a step that leads from first to last"),
            _ => Ok(DataFile::Pattern { name, first, last, step, subdimension: subdimension.flatten() }),
        }
    }
}

fn center(name: &str) -> Option<Option<Center>> {
    match name.to_lowercase().as_str() {
        "cell" => Some(Some(Center::Cell)),
        "node" => Some(Some(Center::Node)),
        "???" | "none" => Some(None),
        _ => None,
    }
}

/// Splits `name%d first last step …`: the name may hold blanks, so the numbers are those at the end.
fn numbered_files(value: &str) -> Option<(NumberedName, Vec<i64>)> {
    let mut rest = value;
    let mut numbers = Vec::new();
    while numbers.len() <= 4
        && let Some((before, word)) = rest.rsplit_once(char::is_whitespace)
        && let Ok(number) = word.parse()
    {
        numbers.insert(0, number);
        rest = before.trim_end();
    }
    (numbers.len() >= 3).then_some(())?;
    Some((NumberedName::parse(rest)?, numbers))
}
