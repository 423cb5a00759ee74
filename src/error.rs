//! One error type, sorted by whose fault it is.
//!
//! Every error says what is wrong and, as far as they apply: which file, which element or line, what was found, what
//! was expected, and one remedy. The process exit code follows from [`Fault`] alone, so scripts can rely on it.

use std::fmt;
use std::path::{Path, PathBuf};

/// Whose fault an error is; decides the exit code of the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fault {
    /// A bug in pellucid: an invariant of ours did not hold.
    Internal,
    /// The pipeline or preset that the author wrote.
    Spec,
    /// The input is missing, unreadable or damaged, or holds no usable series.
    Input,
    /// The input is valid, but this build cannot decode it or does not implement what is asked.
    Unsupported,
    /// The geometry of the input is refused: gaps, mixed orientations, degenerate axes.
    Geometry,
    /// The machine's limits: memory.
    Limit,
    /// The result could not be written.
    Output,
    /// A picture was made, but it is not within the tolerance that was asked for.
    Tolerance,
}

impl Fault {
    /// Exit code of the process; part of the stable interface. 0 is success and 2 is left to the argument parser.
    pub fn exit_code(self) -> u8 {
        match self {
            Fault::Internal => 1,
            Fault::Spec => 3,
            Fault::Input => 4,
            Fault::Unsupported => 5,
            Fault::Geometry => 6,
            Fault::Limit => 7,
            Fault::Output => 8,
            Fault::Tolerance => 9,
        }
    }
}

/// A place in a text file: 1-based line and column, and the byte range it covers where that is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextPlace {
    /// Line, counted from 1.
    pub line: usize,
    /// Column, counted from 1.
    pub column: usize,
    /// Byte offset and length in the text, for a marked snippet.
    pub span: Option<(usize, usize)>,
    /// The whole text, so that the binary can show the lines around the place.
    pub text: String,
}

/// An error with everything a user needs to mend its cause.
///
/// Built in one expression: `Error::new(Fault::Geometry, "…").at(path).element("slice 12").found("…").remedy("…")`.
/// Boxed inside, so that `Result<T>` stays small.
///
/// The text of an error holds its causes, so [`std::error::Error::source`] gives none of them again; see [`Error::cause`].
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Error(Box<Details>);

#[derive(Debug)]
struct Details {
    fault: Fault,
    what: String,
    path: Option<PathBuf>,
    element: Option<String>,
    place: Option<TextPlace>,
    found: Option<String>,
    expected: Option<String>,
    remedy: Option<String>,
    source: Option<Box<dyn std::error::Error + Send + Sync>>,
}

/// Result with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// An error of this fault; `what` is one clause in lower case, without a full stop.
    pub fn new(fault: Fault, what: impl Into<String>) -> Self {
        Error(Box::new(Details {
            fault,
            what: what.into(),
            path: None,
            element: None,
            place: None,
            found: None,
            expected: None,
            remedy: None,
            source: None,
        }))
    }

    /// Names the file or folder.
    #[must_use]
    pub fn at(mut self, path: impl AsRef<Path>) -> Self {
        self.0.path = Some(path.as_ref().to_path_buf());
        self
    }

    /// Names the element: a DICOM tag, a header field, a key path such as `camera.fov_degrees`, a slice.
    #[must_use]
    pub fn element(mut self, element: impl Into<String>) -> Self {
        self.0.element = Some(element.into());
        self
    }

    /// Gives the place in a text file.
    #[must_use]
    pub fn place(mut self, place: TextPlace) -> Self {
        self.0.place = Some(place);
        self
    }

    /// Says what was found there.
    #[must_use]
    pub fn found(mut self, found: impl Into<String>) -> Self {
        self.0.found = Some(found.into());
        self
    }

    /// Says what was expected instead.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.0.expected = Some(expected.into());
        self
    }

    /// Gives one thing the user can do about it.
    #[must_use]
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.0.remedy = Some(remedy.into());
        self
    }

    /// Keeps the error of a library as the cause.
    #[must_use]
    pub fn caused_by(mut self, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        self.0.source = Some(source.into());
        self
    }

    /// Whose fault it is.
    pub fn fault(&self) -> Fault {
        self.0.fault
    }

    /// The clause that says what is wrong.
    pub fn what(&self) -> &str {
        &self.0.what
    }

    /// The file or folder, where one is concerned.
    pub fn path(&self) -> Option<&Path> {
        self.0.path.as_deref()
    }

    /// The key path or element, where one is concerned.
    pub fn element_name(&self) -> Option<&str> {
        self.0.element.as_deref()
    }

    /// The place in a text file, where one is concerned.
    pub fn text_place(&self) -> Option<&TextPlace> {
        self.0.place.as_ref()
    }

    /// The error of a library behind this one.
    pub fn cause(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source.as_deref().map(|source| source as &(dyn std::error::Error + 'static))
    }

    /// The first line of the text: everything but the causes and the remedy.
    pub fn headline(&self) -> String {
        Headline(&self.0).to_string()
    }

    /// What the user can do.
    pub fn remedy_text(&self) -> Option<&str> {
        self.0.remedy.as_deref()
    }
}

/// `path:line:column: what (element): found X, expected Y`.
struct Headline<'a>(&'a Details);

impl fmt::Display for Headline<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Details { what, path, element, place, found, expected, .. } = self.0;
        if let Some(path) = path {
            write!(f, "{}", path.display())?;
            if let Some(place) = place {
                write!(f, ":{}:{}", place.line, place.column)?;
            }
            f.write_str(": ")?;
        }
        f.write_str(what)?;
        if let Some(element) = element {
            write!(f, " ({element})")?;
        }
        match (found, expected) {
            (Some(found), Some(expected)) => write!(f, ": found {found}, expected {expected}"),
            (Some(found), None) => write!(f, ": found {found}"),
            (None, Some(expected)) => write!(f, ": expected {expected}"),
            (None, None) => Ok(()),
        }
    }
}

/// The headline, then the chain of causes and the remedy on lines of their own.
impl fmt::Display for Details {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Headline(self).fmt(f)?;
        let mut cause = self.source.as_deref().map(|source| source as &dyn std::error::Error);
        while let Some(this) = cause {
            write!(f, "\n  cause: {this}")?;
            cause = this.source();
        }
        if let Some(remedy) = &self.remedy {
            write!(f, "\n  remedy: {remedy}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_names_file_element_found_expected_and_remedy() {
        let error = Error::new(Fault::Geometry, "slices are not evenly spaced")
            .at("scans/head")
            .element("slice 12")
            .found("a step of 4 mm")
            .expected("2 mm")
            .remedy("export the series again with all its slices");
        assert_eq!(
            error.to_string(),
            "scans/head: slices are not evenly spaced (slice 12): found a step of 4 mm, expected 2 mm\n  \
             remedy: export the series again with all its slices"
        );
        assert_eq!(error.fault().exit_code(), 6, "geometry has its own exit code");
    }

    #[test]
    fn every_cause_is_told_once() {
        #[derive(Debug, thiserror::Error)]
        #[error("the file is truncated")]
        struct Truncated(#[source] std::io::Error);

        let cause = Truncated(std::io::Error::other("unexpected end"));
        let error = Error::new(Fault::Input, "the header could not be read").at("a.nrrd").caused_by(cause);
        assert_eq!(
            error.to_string(),
            "a.nrrd: the header could not be read\n  cause: the file is truncated\n  cause: unexpected end"
        );
        assert_eq!(error.headline(), "a.nrrd: the header could not be read");
        assert!(std::error::Error::source(&error).is_none(), "the text already holds the causes");
    }
}
