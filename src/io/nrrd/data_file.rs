//! Where the elements are: in the same file, in another one, or spread over many (field `data file`).

use crate::error::{Error, Fault, Result};

/// Where the elements are. Names are relative to the folder of the header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DataFile {
    /// After the header, in the same file.
    Attached,
    /// In one other file.
    Single(String),
    /// In these files, in this order.
    List {
        /// Their names.
        names: Vec<String>,
        /// Number of axes that each file holds; one less than the array has if not given.
        subdimension: Option<usize>,
    },
    /// In numbered files.
    Pattern {
        /// What their names have in common.
        name: NumberedName,
        /// First number.
        first: i64,
        /// Bound of the numbers, itself included.
        last: i64,
        /// Distance between numbers; not 0.
        step: i64,
        /// Number of axes that each file holds; one less than the array has if not given.
        subdimension: Option<usize>,
    },
}

/// How the elements are divided among files: equal pieces, in the order of the slowest axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Division {
    /// Number of files.
    pub(super) files: usize,
    /// Elements in each.
    pub(super) elements: usize,
}

impl DataFile {
    /// Number of files.
    pub fn count(&self) -> usize {
        match self {
            DataFile::Attached | DataFile::Single(_) => 1,
            DataFile::List { names, .. } => names.len(),
            DataFile::Pattern { first, last, step, .. } => {
                let steps = (i128::from(*last) - i128::from(*first)) / i128::from(*step);
                usize::try_from(steps + 1).unwrap_or(usize::MAX)
            }
        }
    }

    /// Name of one of the files; `None` where the data is attached.
    pub fn name(&self, index: usize) -> Option<String> {
        match self {
            DataFile::Attached => None,
            DataFile::Single(name) => Some(name.clone()),
            DataFile::List { names, .. } => names.get(index).cloned(),
            DataFile::Pattern { name, first, step, .. } => {
                let number = i128::from(*first) + index as i128 * i128::from(*step);
                Some(name.with_number(i64::try_from(number).ok()?))
            }
        }
    }

    /// How an array of these sizes is divided among the files.
    ///
    /// # Errors
    /// `Fault::Input` if the number of files does not fit the sizes.
    pub(super) fn division(&self, sizes: &[usize], elements: usize) -> Result<Division> {
        let files = self.count();
        let subdimension = match self {
            DataFile::Attached | DataFile::Single(_) => return Ok(Division { files: 1, elements }),
            DataFile::List { subdimension, .. } | DataFile::Pattern { subdimension, .. } => {
                subdimension.unwrap_or(sizes.len().saturating_sub(1))
            }
        };
        let wrong = |found: String, expected: String| {
            Err(Error::new(Fault::Input, "the number of data files does not fit the sizes")
                .element("data file")
                .found(found)
                .expected(expected))
        };
        let slowest = sizes.last().copied().unwrap_or(1);
        if subdimension >= sizes.len() {
            // Each file is a slab with as many axes as the array: they share the slowest one equally.
            if files == 0 || !slowest.is_multiple_of(files) {
                return wrong(format!("{files} files"), format!("a number that divides {slowest} samples"));
            }
        } else {
            let expected: usize = sizes[subdimension..].iter().product();
            if files != expected {
                return wrong(
                    format!("{files} files of {subdimension} axes"),
                    format!("{expected} for sizes {sizes:?}"),
                );
            }
        }
        Ok(Division { files, elements: elements / files })
    }
}

/// A file name with a number in it, as `printf` writes it: `slice.%03d`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NumberedName {
    before: String,
    after: String,
    width: usize,
    digits: usize,
    pad: Pad,
    sign: &'static str,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pad {
    Left,
    Right,
    Zeros,
}

/// File names end long before this.
const MAX_WIDTH: usize = 255;

impl NumberedName {
    /// The pattern, or `None` if the text has not exactly one conversion of the kind `%[-+ 0][width][.digits]d`.
    pub fn parse(text: &str) -> Option<Self> {
        let mut name =
            NumberedName { before: String::new(), after: String::new(), width: 0, digits: 1, pad: Pad::Left, sign: "" };
        let mut seen = false;
        let mut rest = text;
        while let Some(at) = rest.find('%') {
            let literal = if seen { &mut name.after } else { &mut name.before };
            literal.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            if let Some(after) = rest.strip_prefix('%') {
                literal.push('%');
                rest = after;
            } else if seen {
                return None;
            } else {
                rest = name.parse_conversion(rest)?;
                seen = true;
            }
        }
        name.after.push_str(rest);
        seen.then_some(name)
    }

    /// Reads what follows the percent sign and gives back the rest of the text.
    fn parse_conversion<'a>(&mut self, text: &'a str) -> Option<&'a str> {
        let flags = &text[..text.find(|c| !"-+ 0".contains(c))?];
        let text = &text[flags.len()..];
        let (width, text) = leading_number(text)?;
        let (digits, text) = match text.strip_prefix('.') {
            Some(text) => leading_number(text).map(|(n, rest)| (Some(n.unwrap_or(0)), rest))?,
            None => (None, text),
        };
        self.width = width.unwrap_or(0);
        self.digits = digits.unwrap_or(1);
        self.sign = match flags {
            f if f.contains('+') => "+",
            f if f.contains(' ') => " ",
            _ => "",
        };
        // As in C: a minus wins over a zero, and digits asked for switch the zero off.
        self.pad = match flags {
            f if f.contains('-') => Pad::Right,
            f if f.contains('0') && digits.is_none() => Pad::Zeros,
            _ => Pad::Left,
        };
        text.strip_prefix(['d', 'i', 'u'])
    }

    /// The name with this number.
    pub fn with_number(&self, number: i64) -> String {
        let sign = if number < 0 { "-" } else { self.sign };
        let digits = format!("{:0width$}", number.unsigned_abs(), width = self.digits);
        let room = self.width.saturating_sub(sign.len() + digits.len());
        let number = match self.pad {
            Pad::Left => format!("{}{sign}{digits}", " ".repeat(room)),
            Pad::Right => format!("{sign}{digits}{}", " ".repeat(room)),
            Pad::Zeros => format!("{sign}{}{digits}", "0".repeat(room)),
        };
        format!("{}{number}{}", self.before, self.after)
    }
}

/// The number at the start of the text, if there is one, and the rest; `None` if it is too large for a file name.
fn leading_number(text: &str) -> Option<(Option<usize>, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    if end == 0 {
        return Some((None, text));
    }
    let number = text[..end].parse().ok().filter(|&n| n <= MAX_WIDTH)?;
    Some((Some(number), &text[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_printf_writes_them() {
        let write = |pattern: &str, n| NumberedName::parse(pattern).map(|p| p.with_number(n));
        for (pattern, number, expected) in [
            ("quarter.%d", 93, "quarter.93"),
            ("a/slice%03d.raw", 7, "a/slice007.raw"),
            ("%3d", 7, "  7"),
            ("%-3dx", 7, "7  x"),
            ("%+d", 7, "+7"),
            ("% d", 7, " 7"),
            ("%05d", -42, "-0042"),
            ("%.4d", 42, "0042"),
            ("%06.4d", 42, "  0042"),
            ("100%%.%i", 2, "100%.2"),
        ] {
            assert_eq!(write(pattern, number).as_deref(), Some(expected), "{pattern} with {number}");
        }
        for pattern in ["plain", "%", "%s", "%d.%d", "%999d", "%99999999999999999999d", "é%", "%é"] {
            assert_eq!(write(pattern, 1), None, "{pattern} has not one conversion");
        }
    }

    #[test]
    fn files_divide_the_slowest_axes() {
        let list = |n: usize, subdimension| DataFile::List { names: vec![String::new(); n], subdimension };
        let divide = |file: DataFile| file.division(&[4, 3, 6], 72).map(|d| (d.files, d.elements)).ok();
        assert_eq!(divide(list(6, None)), Some((6, 12)), "one slice in each file");
        assert_eq!(divide(list(18, Some(1))), Some((18, 4)), "one row in each file");
        assert_eq!(divide(list(2, Some(3))), Some((2, 36)), "two slabs");
        assert_eq!(divide(list(4, Some(3))), None, "four slabs do not divide six slices");
        assert_eq!(divide(list(5, None)), None, "a file is missing");
        assert_eq!(divide(list(0, Some(3))), None, "no files");
    }

    #[test]
    fn numbers_may_go_down_and_stop_short_of_the_bound() {
        let name = NumberedName::parse("s%d").unwrap();
        let file = |first, last, step| DataFile::Pattern { name: name.clone(), first, last, step, subdimension: None };
        let names = |file: DataFile| (0..file.count()).filter_map(|i| file.name(i)).collect::<Vec<_>>();
        assert_eq!(names(file(1, 6, 2)), ["s1", "s3", "s5"]);
        assert_eq!(names(file(3, 1, -1)), ["s3", "s2", "s1"]);
        assert_eq!(file(i64::MIN, i64::MAX, 1).count(), usize::MAX, "no overflow");
    }
}
