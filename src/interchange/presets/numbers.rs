//! Lists of numbers as MRML writes them: how many follow, then the numbers, then no more.

use super::function::{Function, Node};
use crate::error::{Error, Fault, Result};

/// A function with its points as `x y` or `x r g b`, from a list that begins with its count of *numbers*.
pub(super) fn counted<const N: usize>(text: &str) -> Result<Function<N>> {
    let mut words = text.split_ascii_whitespace();
    let damaged = |what: &str| Error::new(Fault::Input, what.to_owned());
    let first = words.next().ok_or_else(|| damaged("a list of numbers is empty").expected("how many follow"))?;
    let count: usize = first.parse().map_err(|_| {
        damaged("a list of numbers does not begin with a count").found(first).expected("how many numbers follow")
    })?;
    let numbers = words.enumerate().map(|(i, word)| {
        let number = word.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| damaged(&format!("number {} of a list is none", i + 1)).found(word))
    });
    let numbers = numbers.collect::<Result<Vec<f64>>>()?;
    if numbers.len() != count {
        let error = damaged("a list does not hold as many numbers as it says");
        return Err(error.found(format!("{} numbers", numbers.len())).expected(format!("{count}")));
    }
    let (points, rest) = numbers.split_at(count - count % (N + 1));
    if !rest.is_empty() {
        let error = damaged("a list ends within a point");
        return Err(error.found(format!("{count} numbers")).expected(format!("a multiple of {}", N + 1)));
    }
    let node = |point: &[f64]| Node::linear(point[0], std::array::from_fn(|i| point[i + 1]));
    Function::new(points.chunks_exact(N + 1).map(node).collect())
}

/// The same list as text.
pub(super) fn written<const N: usize>(function: &Function<N>) -> String {
    let nodes = function.nodes();
    let mut text = (nodes.len() * (N + 1)).to_string();
    for node in nodes {
        for number in std::iter::once(node.x).chain(node.y) {
            text.push_str(&format!(" {number}"));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_read_and_written() {
        let text = "8 -3024 0 0 0 1.5 1 0.5 0.25";
        let function = counted::<3>(text).expect("a list of 8 numbers, 2 points");
        assert_eq!(function.nodes()[1], Node::linear(1.5, [1.0, 0.5, 0.25]));
        assert_eq!(written(&function), text);
    }

    #[test]
    fn a_broken_list_says_how() {
        for (text, says) in [
            ("", "empty"),
            ("many 1 2", "found many"),
            ("4 0 0 1", "found 3 numbers, expected 4"),
            ("4 0 0 1 1 2", "found 5 numbers, expected 4"),
            ("3 0 0 1", "multiple of 2"),
            ("4 0 zero 1 1", "number 2 of a list is none: found zero"),
            ("4 0 inf 1 1", "found inf"),
            ("4 5 0 1 1", "point 2"),
            ("2 0 7", "from 0 to 1"),
            ("0", "number of points"),
        ] {
            let error = counted::<1>(text).expect_err(text).to_string();
            assert!(error.contains(says), "{text:?}: found {error:?}, expected it to say {says:?}");
        }
    }
}
