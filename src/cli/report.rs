//! Errors as people read them: what, where, the line of YAML with the place marked, the chain of causes, one remedy.

use std::fmt;

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode, SourceOffset};
use pellucid::Error;

use super::stderr;

/// Prints an error to stderr.
pub(crate) fn print(error: &Error) {
    stderr::say(&text(error, stderr::wants_color()));
}

/// The whole message. The first line is `error: path:line:column: what: found …, expected …` on one line, so that it can
/// be searched for and editors can jump to it.
fn text(error: &Error, color: bool) -> String {
    let mut message = format!("error: {}", error.headline());
    if let Some(report) = Marked::of(error) {
        let theme = if color { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
        let mut snippet = String::new();
        // Only the snippet: what the rest of miette's layout says stands in the lines before and after it.
        if GraphicalReportHandler::new_themed(theme).with_width(120).render_report(&mut snippet, &report).is_ok() {
            for line in snippet.lines().skip_while(|l| !l.contains("╭─")) {
                message.push('\n');
                message.push_str(line);
            }
        }
    }
    let mut cause = error.cause();
    while let Some(this) = cause {
        message.push_str(&format!("\n  cause: {this}"));
        cause = this.source();
    }
    if let Some(remedy) = error.remedy_text() {
        message.push_str(&format!("\n  remedy: {remedy}"));
    }
    message
}

/// An error with a place in a text, as miette draws it.
#[derive(Debug)]
struct Marked {
    source: NamedSource<String>,
    label: LabeledSpan,
}

impl Marked {
    fn of(error: &Error) -> Option<Marked> {
        let place = error.text_place()?;
        let (offset, length) = place
            .span
            .unwrap_or_else(|| (SourceOffset::from_location(&place.text, place.line, place.column).offset(), 1));
        if place.text.is_empty() || offset > place.text.len() {
            return None;
        }
        let name = error.path().map_or_else(|| "pipeline".to_string(), |path| path.display().to_string());
        Some(Marked {
            source: NamedSource::new(name, place.text.clone()),
            label: LabeledSpan::new(None, offset, length.min(place.text.len() - offset)),
        })
    }
}

impl fmt::Display for Marked {
    fn fmt(&self, _: &mut fmt::Formatter<'_>) -> fmt::Result {
        Ok(())
    }
}

impl std::error::Error for Marked {}

impl Diagnostic for Marked {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(std::iter::once(self.label.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pellucid::Fault;
    use pellucid::error::TextPlace;

    fn misspelt() -> Error {
        let text = "version: 1\ncamera:\n  azimut: 25\n".to_string();
        Error::new(Fault::Spec, "unknown key")
            .at("pipelines/skull.yaml")
            .element("camera.azimut")
            .place(TextPlace { line: 3, column: 3, span: Some((21, 6)), text })
            .remedy("write `azimuth`")
    }

    #[test]
    fn the_line_of_yaml_is_shown_with_the_place_marked() {
        let shown = text(&misspelt(), false);
        assert!(shown.starts_with("error: pipelines/skull.yaml:3:3: unknown key (camera.azimut)\n"), "found:\n{shown}");
        assert!(shown.contains("azimut: 25"), "the line itself; found:\n{shown}");
        assert!(shown.contains("──"), "a mark under it; found:\n{shown}");
        assert!(shown.ends_with("remedy: write `azimuth`"), "the remedy comes last; found:\n{shown}");
        assert!(!shown.contains('\u{1b}'), "no colours unless asked for; found:\n{shown}");
    }

    #[test]
    fn a_place_without_a_span_marks_its_column() {
        let text_of = "a: 1\nb: [\n".to_string();
        let place = TextPlace { line: 2, column: 4, span: None, text: text_of };
        let shown = text(&Error::new(Fault::Spec, "not closed").at("p.yaml").place(place), false);
        assert!(shown.contains("p.yaml:2:4") && shown.contains("b: ["), "found:\n{shown}");
    }

    #[test]
    fn causes_follow_one_another() {
        let io = std::io::Error::other("disk on fire");
        let shown = text(&Error::new(Fault::Output, "the picture could not be written").caused_by(io), false);
        assert_eq!(shown, "error: the picture could not be written\n  cause: disk on fire");
    }
}
