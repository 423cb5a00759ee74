//! A header as lines: which fields it has and where they stand, before anybody asks what they mean.

use std::path::{Path, PathBuf};

use super::field::Field;
use crate::error::{Error, Fault, Result, TextPlace};

/// A header cut into its lines.
#[derive(Debug)]
pub(super) struct Lines {
    path: PathBuf,
    text: String,
    /// Version of the format, 1 to 5.
    pub(super) version: u8,
    fields: Vec<(Field, Entry)>,
    /// Key/value pairs without their escapes.
    pub(super) key_values: Vec<(String, String)>,
    /// Comments without their mark.
    pub(super) comments: Vec<String>,
    /// File names after `data file: LIST`.
    pub(super) listed_files: Vec<String>,
    /// What a careful reader should know.
    pub(super) warnings: Vec<String>,
}

/// The description of one field, and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// The text after the colon, without the blanks around it.
    pub(super) value: String,
    line: usize,
    start: usize,
    length: usize,
}

impl Lines {
    /// Cuts a header into lines; `text` ends before the blank line.
    ///
    /// # Errors
    /// `Fault::Input` for a text that is no NRRD header, `Fault::Unsupported` for a version from the future.
    pub(super) fn parse(path: &Path, text: String) -> Result<Self> {
        let mut lines = Lines {
            path: path.to_path_buf(),
            version: version(path, text.lines().next().unwrap_or_default())?,
            fields: Vec::new(),
            key_values: Vec::new(),
            comments: Vec::new(),
            listed_files: Vec::new(),
            warnings: Vec::new(),
            text,
        };
        let mut start = 0;
        let text = std::mem::take(&mut lines.text);
        let mut in_list = false;
        let mut unread = Vec::new();
        for (index, whole) in text.split_inclusive('\n').enumerate() {
            let line = whole.trim_end_matches(['\n', '\r']);
            let entry = Entry { value: line.to_owned(), line: index + 1, start, length: line.len() };
            start += whole.len();
            if index == 0 {
                continue;
            } else if in_list {
                lines.listed_files.push(line.trim().to_owned());
            } else if let Some(comment) = line.strip_prefix('#') {
                lines.comments.push(comment.trim().to_owned());
            } else if let Some(field) = lines.cut(&entry, &mut unread) {
                in_list = field.0 == Field::DataFile && is_list(&field.1.value);
                lines.fields.push(field);
            }
        }
        lines.text = text;
        lines.refuse_unread(unread)?;
        lines.refuse_contradictions()?;
        Ok(lines)
    }

    /// Reads one line as a key/value pair or as a field; what is neither goes to `unread`.
    fn cut(&mut self, entry: &Entry, unread: &mut Vec<Entry>) -> Option<(Field, Entry)> {
        let line = &entry.value;
        let colon = line.find(':');
        let name = &line[..colon.unwrap_or(line.len())];
        if let Some(at) = colon
            && !line[at..].starts_with(":=")
            && let Some(field) = Field::from_name(name)
        {
            let after = &line[at + 1..];
            let value = after.trim();
            let value_start = at + 1 + (after.len() - after.trim_start().len());
            let start = entry.start + value_start;
            let (value, length) = (value.to_owned(), value.len());
            return Some((field, Entry { value, line: entry.line, start, length }));
        }
        match line.split_once(":=") {
            Some((key, value)) => self.key_values.push((without_escapes(key), without_escapes(value))),
            None => unread.push(entry.clone()),
        }
        None
    }

    /// A line without a colon, or a field whose name is nearly a known one, is an error; other fields are left to
    /// those who know them.
    fn refuse_unread(&mut self, unread: Vec<Entry>) -> Result<()> {
        for entry in unread {
            let Some((name, _)) = entry.value.split_once(':') else {
                return Err(self
                    .error(Fault::Input, "a line of the header is neither a field nor a key/value pair", &entry)
                    .found(format!("{:?}", clip(&entry.value)))
                    .expected("`field: description`, `key:=value`, or a blank line before the data"));
            };
            if let Some(meant) = Field::meant_by(name) {
                return Err(self
                    .error(Fault::Input, "a field is not known", &entry)
                    .found(format!("`{name}`"))
                    .remedy(format!("write `{meant}`, or `{name}:=…` for a key of your own")));
            }
            self.warnings.push(format!(
                "line {}: the field `{}` is not known and was not used",
                entry.line,
                clip(name)
            ));
        }
        Ok(())
    }

    /// A field given twice is a warning if both say the same, and an error if not.
    fn refuse_contradictions(&mut self) -> Result<()> {
        for (index, (field, entry)) in self.fields.iter().enumerate() {
            let Some((_, first)) = self.fields[..index].iter().find(|(earlier, _)| earlier == field) else { continue };
            if first.value != entry.value {
                return Err(self
                    .error(Fault::Input, "a field is given twice", entry)
                    .element(field.name())
                    .found(format!("`{}` after `{}` in line {}", clip(&entry.value), clip(&first.value), first.line))
                    .remedy("remove the wrong one"));
            }
            self.warnings.push(format!(
                "lines {} and {}: the field `{}` is given twice, alike",
                first.line,
                entry.line,
                field.name()
            ));
        }
        Ok(())
    }

    /// The entry of a field, the first if it was given twice alike.
    pub(super) fn get(&self, field: Field) -> Option<&Entry> {
        self.fields.iter().find(|(f, _)| *f == field).map(|(_, entry)| entry)
    }

    /// The entry of a field that every header must have.
    ///
    /// # Errors
    /// `Fault::Input` if it is missing.
    pub(super) fn require(&self, field: Field) -> Result<&Entry> {
        self.get(field)
            .ok_or_else(|| Error::new(Fault::Input, "a required field is missing").at(&self.path).element(field.name()))
    }

    /// An error in the description of a field.
    pub(super) fn error(&self, fault: Fault, what: &str, entry: &Entry) -> Error {
        let column = 1 + self.text[..entry.start].chars().rev().take_while(|&c| c != '\n').count();
        Error::new(fault, what).at(&self.path).place(TextPlace {
            line: entry.line,
            column,
            span: Some((entry.start, entry.length)),
            text: self.text.clone(),
        })
    }
}

/// Reads the first line.
fn version(path: &Path, magic: &str) -> Result<u8> {
    let magic = magic.trim_end();
    let digits = magic.strip_prefix("NRRD").ok_or_else(|| {
        Error::new(Fault::Input, "this is not a NRRD file")
            .at(path)
            .found(format!("{:?} in the first line", clip(magic)))
            .expected("NRRD0001 to NRRD0005")
    })?;
    match digits {
        // The first files were written before the format had a number of four digits.
        "00.01" => Ok(1),
        "0001" | "0002" | "0003" | "0004" | "0005" => Ok(digits.as_bytes()[3] - b'0'),
        _ => Err(Error::new(Fault::Unsupported, "this version of NRRD is not known")
            .at(path)
            .found(format!("{:?} in the first line", clip(magic)))
            .expected("NRRD0001 to NRRD0005")),
    }
}

/// True for `LIST` and `LIST 2`, false for a file whose name begins so.
pub(super) fn is_list(value: &str) -> bool {
    let mut words = value.split_whitespace();
    words.next() == Some("LIST") && words.next().is_none_or(|n| n.bytes().all(|b| b.is_ascii_digit()))
}

/// Undoes the escapes of keys and values: `\n` for a line feed, `\\` for a backslash.
fn without_escapes(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        match (c, rest.clone().next()) {
            ('\\', Some('n')) => plain.push('\n'),
            ('\\', Some('\\')) => plain.push('\\'),
            _ => {
                plain.push(c);
                continue;
            }
        }
        rest.next();
    }
    plain
}

/// The start of a text, for messages.
pub(super) fn clip(text: &str) -> String {
    const LONGEST: usize = 60;
    let start: String = text.chars().take(LONGEST).collect();
    if start.len() < text.len() { start + "…" } else { start }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Lines> {
        Lines::parse(Path::new("a.nrrd"), text.to_owned())
    }

    #[test]
    fn fields_keys_and_comments_are_told_apart() {
        let lines =
            parse("NRRD0005\r\n# made by hand\nSIZES:  2 3\nA:=b: c\\n\\\\d\\x\ndicom: x:=1\nvendor: 7\n").unwrap();
        assert_eq!((lines.version, lines.comments.as_slice()), (5, ["made by hand".to_owned()].as_slice()));
        assert_eq!(lines.get(Field::Sizes).unwrap().value, "2 3");
        let pairs: Vec<_> = lines.key_values.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
        assert_eq!(pairs, [("A", "b: c\n\\d\\x"), ("dicom: x", "1")]);
        assert_eq!(lines.warnings, ["line 6: the field `vendor` is not known and was not used"]);
    }

    #[test]
    fn errors_mark_their_place() {
        let error = parse("NRRD0004\ntype: short\ntype:  float\n").unwrap_err();
        assert_eq!(
            error.to_string(),
            "a.nrrd:3:8: a field is given twice (type): found `float` after `short` in line 2\n  \
             remedy: remove the wrong one"
        );
        let place = error.text_place().unwrap();
        let (start, length) = place.span.unwrap();
        assert_eq!(&place.text[start..start + length], "float");
    }
}
