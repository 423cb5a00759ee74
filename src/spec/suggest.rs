//! Did you mean …?

/// The known name nearest to what was written, as a remedy, if one is near.
pub(super) fn did_you_mean<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let lower = written.to_lowercase();
    known
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&lower, name), name))
        .filter(|(likeness, _)| *likeness >= 0.8)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, name)| format!("did you mean {name}?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_name_is_suggested_and_a_far_one_is_not() {
        let known = ["ambient", "diffuse", "specular"];
        assert_eq!(did_you_mean("ambint", known).as_deref(), Some("did you mean ambient?"));
        assert_eq!(did_you_mean("Diffuse", known).as_deref(), Some("did you mean diffuse?"));
        assert_eq!(did_you_mean("colour", known), None);
    }
}
