//! The little languages of the descriptions: numbers, vectors, quoted names.

/// Numbers between blanks; `nan` stands for a number that is not given.
pub(super) fn numbers(text: &str) -> Option<Vec<Option<f64>>> {
    text.split_whitespace()
        .map(|word| match word.parse::<f64>().ok()? {
            x if x.is_nan() => Some(None),
            x if x.is_finite() => Some(Some(x)),
            _ => None,
        })
        .collect()
}

/// Vectors `(1,0,0)` with finite components, or `none`; blanks may stand anywhere between the numbers.
pub(super) fn vectors(text: &str) -> Option<Vec<Option<Vec<f64>>>> {
    let mut found = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        if let Some(after) = rest.strip_prefix('(') {
            let (inside, after) = after.split_once(')')?;
            found.push(vector(inside)?);
            rest = after;
        } else {
            let (word, after) = rest.split_at(rest.find(|c: char| c == '(' || c.is_whitespace()).unwrap_or(rest.len()));
            if !word.eq_ignore_ascii_case("none") {
                return None;
            }
            found.push(None);
            rest = after;
        }
        rest = rest.trim_start();
    }
    Some(found)
}

/// Components between commas; a vector of nothing but `nan` is another way to write `none`.
fn vector(inside: &str) -> Option<Option<Vec<f64>>> {
    let components: Vec<f64> = inside.split(',').map(|x| x.trim().parse().ok()).collect::<Option<_>>()?;
    if components.iter().all(|x| x.is_nan()) {
        return Some(None);
    }
    components.iter().all(|x| x.is_finite()).then_some(Some(components))
}

/// Strings in double quotes, with `\"` for a quote inside; also single words without quotes, as some programs write.
pub(super) fn strings(text: &str) -> Option<Vec<String>> {
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        rest = match rest.strip_prefix('"') {
            Some(quoted) => {
                let (string, after) = until_quote(quoted)?;
                found.push(string);
                after
            }
            None => {
                let (word, after) = rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len()));
                found.push(word.to_owned());
                after
            }
        }
        .trim_start();
    }
    Some(found)
}

fn until_quote(text: &str) -> Option<(String, &str)> {
    let mut string = String::new();
    let mut characters = text.char_indices();
    while let Some((at, c)) = characters.next() {
        match c {
            '"' => return Some((string, &text[at + 1..])),
            '\\' if text[at + 1..].starts_with(['"', '\\']) => string.push(characters.next()?.1),
            _ => string.push(c),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_may_be_left_out_but_not_be_infinite() {
        assert_eq!(numbers("3.2  nan -1e2"), Some(vec![Some(3.2), None, Some(-100.0)]));
        assert_eq!(numbers("1 inf"), None);
        assert_eq!(numbers("1 x"), None);
        assert_eq!(numbers(""), Some(vec![]));
    }

    #[test]
    fn vectors_may_be_none() {
        let expected = vec![None, Some(vec![1.0, -0.5]), None, Some(vec![0.0, 2.0])];
        assert_eq!(vectors(" none (1,-.5)NONE ( 0 , 2 ) "), Some(expected));
        assert_eq!(vectors("(nan,nan) (0,1)"), Some(vec![None, Some(vec![0.0, 1.0])]));
        for text in ["(1,2", "(1,,2)", "1,2", "(nan,1)", "(inf,1)", "nones", "()"] {
            assert_eq!(vectors(text), None, "{text}");
        }
    }

    #[test]
    fn strings_may_hold_blanks_and_quotes() {
        let expected = ["mm", "", "a \"b\" \\c", "s"].map(str::to_owned).to_vec();
        assert_eq!(strings(r#""mm" "" "a \"b\" \\c" s"#), Some(expected));
        assert_eq!(strings("\"mm"), None, "the quote is left open");
    }
}
