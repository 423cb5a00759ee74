//! Reads from Rust source which of the crate's own modules it names.

/// A module named in a source file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Use {
    /// Line, counted from 1.
    pub(super) line: usize,
    /// The top-level module.
    pub(super) used: String,
}

/// Top-level modules that `source` names by `crate::…` paths, groups and names re-exported at the root included, or by
/// a `super::` chain that leaves its own top-level module.
pub(super) fn uses(path: &str, source: &str, root_names: &[(String, String)]) -> Vec<Use> {
    let code = without_comments_and_strings(source);
    let mut found = Vec::new();
    for (start, word) in words(&code) {
        let line = code[..start].matches('\n').count() + 1;
        let rest = &code[start..];
        let named = match word {
            "crate" => rest.strip_prefix("crate::").map(first_segments),
            "super" if !code[..start].ends_with("super::") => above_the_root(rest, depth(path)),
            _ => None,
        };
        for name in named.into_iter().flatten() {
            let used = root_names.iter().find(|(n, _)| *n == name).map_or(name, |(_, module)| module.clone());
            found.push(Use { line, used });
        }
    }
    found
}

/// Names that the library's root re-exports, with the module they come from: `pub use module::{A, B};`.
pub(super) fn root_names(lib: &str) -> Vec<(String, String)> {
    let code = without_comments_and_strings(lib);
    let exports = code.split("pub use ").skip(1).filter_map(|rest| rest.split_once(';')).map(|(path, _)| path);
    let pairs = exports.filter_map(|path| path.split_once("::")).flat_map(|(module, names)| {
        first_segments(names).into_iter().map(move |name| (name, module.trim().to_string()))
    });
    pairs.collect()
}

/// How many modules deep a file's module is: 1 for `src/io/mod.rs` and `src/demand.rs`, 2 for `src/io/png.rs`.
fn depth(path: &str) -> usize {
    let inside = path.trim_start_matches("src/").trim_end_matches(".rs").trim_end_matches("/mod");
    inside.split('/').count()
}

/// The modules that a chain of `super::` at the start of `code` names at the root, if it climbs that far from a module
/// this deep. Only names of modules count: in a module of tests at the end of a file, which is one deeper, `super::name`
/// is an item of the file itself.
fn above_the_root(code: &str, depth: usize) -> Option<Vec<String>> {
    let mut rest = code;
    let mut climbed = 0;
    while let Some(after) = rest.strip_prefix("super::") {
        rest = after;
        climbed += 1;
    }
    let modules = || first_segments(rest).into_iter().filter(|name| super::layer(name).is_some()).collect();
    (climbed >= depth).then(modules)
}

/// The first segment of a path, or of each path of a group `{a::b, c}`.
fn first_segments(path: &str) -> Vec<String> {
    let path = path.trim_start();
    let Some(group) = path.strip_prefix('{') else {
        return identifier(path).map(str::to_string).into_iter().collect();
    };
    let mut segments = Vec::new();
    let mut nested = 0_usize;
    let mut at_start = true;
    for (i, c) in group.char_indices() {
        match c {
            '{' => nested += 1,
            '}' if nested == 0 => break,
            '}' => nested -= 1,
            ',' if nested == 0 => at_start = true,
            c if at_start && !c.is_whitespace() => {
                segments.extend(identifier(&group[i..]).filter(|name| *name != "self").map(str::to_string));
                at_start = false;
            }
            _ => {}
        }
    }
    segments
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn identifier(text: &str) -> Option<&str> {
    let end = text.find(|c| !is_word(c)).unwrap_or(text.len());
    (end > 0).then(|| &text[..end])
}

/// The words of the code with their byte offsets.
fn words(code: &str) -> impl Iterator<Item = (usize, &str)> {
    let starts = code.char_indices().scan(false, |inside, (i, c)| {
        let begins = is_word(c) && !*inside;
        *inside = is_word(c);
        Some(begins.then_some(i))
    });
    starts.flatten().filter_map(|i| identifier(&code[i..]).map(|word| (i, word)))
}

/// The code alone: comments and the insides of literals become spaces, line ends stay.
fn without_comments_and_strings(source: &str) -> String {
    let mut code = String::with_capacity(source.len());
    let mut rest = source;
    while let Some(c) = rest.chars().next() {
        let skipped = literal_or_comment(rest, code.chars().next_back());
        if skipped > 0 {
            code.extend(rest[..skipped].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
            rest = &rest[skipped..];
        } else {
            code.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    code
}

/// Bytes of the comment, string or character literal at the start of `text`; 0 if there is none.
fn literal_or_comment(text: &str, before: Option<char>) -> usize {
    if text.starts_with("//") {
        return text.find('\n').unwrap_or(text.len());
    }
    if text.starts_with("/*") {
        return block_comment(text);
    }
    if text.starts_with('"') {
        return quoted(text, '"');
    }
    if text.starts_with('r') && !before.is_some_and(is_word) {
        let hashes = text[1..].chars().take_while(|c| *c == '#').count();
        if text[1 + hashes..].starts_with('"') {
            let end = format!("\"{}", "#".repeat(hashes));
            let inside = 2 + hashes;
            return text[inside..].find(&end).map_or(text.len(), |i| inside + i + end.len());
        }
    }
    // A character has its closing quote after one, possibly escaped, character; a lifetime has none.
    let mut ahead = text.chars().skip(1);
    match (text.starts_with('\''), ahead.next(), ahead.next()) {
        (true, Some('\\'), _) | (true, Some(_), Some('\'')) => quoted(text, '\''),
        _ => 0,
    }
}

fn block_comment(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut i = 0;
    while i < text.len() {
        let here = &text.as_bytes()[i..];
        if here.starts_with(b"/*") {
            depth += 1;
            i += 2;
        } else if here.starts_with(b"*/") {
            depth -= 1;
            i += 2;
            if depth == 0 {
                return i;
            }
        } else {
            i += 1;
        }
    }
    text.len()
}

fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            c if c == quote => return i + 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_comments_are_not_code() {
        let source = "a /* x /* y */ z */ \"s\\\"t\" r#\"u\"v\"# 'w' '\\'' &'life b // c\nd";
        let code = without_comments_and_strings(source);
        let kept: Vec<&str> = words(&code).map(|(_, word)| word).collect();
        assert_eq!(kept, ["a", "life", "b", "d"]);
        assert_eq!(code.len(), source.len(), "places stay where they were");
    }

    #[test]
    fn groups_give_each_first_segment() {
        assert_eq!(first_segments("{error::{Error, Fault}, volume::Grid, math}"), ["error", "volume", "math"]);
        assert_eq!(first_segments("io::nrrd"), ["io"]);
    }

    #[test]
    fn root_names_come_with_their_module() {
        let names = root_names("pub mod a;\npub use error::{Error, Result};\npub use volume::Volume;\n");
        let pairs: Vec<(&str, &str)> = names.iter().map(|(n, m)| (n.as_str(), m.as_str())).collect();
        assert_eq!(pairs, [("Error", "error"), ("Result", "error"), ("Volume", "volume")]);
    }
}
