//! Attributes of a data set as plain Rust values.
//!
//! A value that is absent or empty is `Ok(None)`; one that is there but does not read as its type is [`Malformed`],
//! because taking it for absent would let a damaged slice pass as a plain one.

use dicom_core::{DataDictionary, Tag};
use dicom_dictionary_std::StandardDataDictionary;
use dicom_object::InMemDicomObject;

/// A value that cannot be read as its type, with the clause that says so.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Malformed(pub(super) String);

/// `Image Position (Patient) (0020,0032)`: keyword as the dictionary spells it, and tag.
pub(super) fn name_of(tag: Tag) -> String {
    let (group, element) = (tag.group(), tag.element());
    match StandardDataDictionary.by_tag(tag) {
        Some(entry) => format!("{} ({group:04X},{element:04X})", entry.alias),
        None => format!("({group:04X},{element:04X})"),
    }
}

/// Text without the padding of PS3.5 §6.2; `None` if absent or blank.
pub(super) fn text(object: &InMemDicomObject, tag: Tag) -> Option<String> {
    let value = object.get(tag)?.to_str().ok()?;
    let trimmed = value.trim_matches([' ', '\0', '\t', '\n', '\r']);
    (!trimmed.is_empty()).then(|| trimmed.to_owned())
}

/// An integer (IS, US, SS, UL).
pub(super) fn integer(object: &InMemDicomObject, tag: Tag) -> Result<Option<i64>, Malformed> {
    let Some(element) = object.get(tag) else { return Ok(None) };
    if element.value().primitive().is_some_and(|value| value.multiplicity() == 0) || text_is_blank(object, tag) {
        return Ok(None);
    }
    element.to_int::<i64>().map(Some).map_err(|_| malformed(object, tag, "an integer"))
}

/// Exactly `N` finite decimal numbers (DS, FD).
pub(super) fn decimals<const N: usize>(object: &InMemDicomObject, tag: Tag) -> Result<Option<[f64; N]>, Malformed> {
    if object.get(tag).is_none() || text_is_blank(object, tag) {
        return Ok(None);
    }
    let expected = if N == 1 { "a finite number".to_owned() } else { format!("{N} finite numbers") };
    let numbers = text(object, tag)
        .map(|text| text.split('\\').map(|number| number.trim().parse::<f64>()).collect::<Result<Vec<_>, _>>());
    match numbers {
        Some(Ok(numbers)) if numbers.iter().all(|number| number.is_finite()) => {
            numbers.try_into().map(Some).map_err(|_| malformed(object, tag, &expected))
        }
        _ => Err(malformed(object, tag, &expected)),
    }
}

/// One finite decimal number.
pub(super) fn decimal(object: &InMemDicomObject, tag: Tag) -> Result<Option<f64>, Malformed> {
    Ok(decimals::<1>(object, tag)?.map(|[number]| number))
}

/// First item of a sequence.
pub(super) fn first_item(object: &InMemDicomObject, tag: Tag) -> Option<&InMemDicomObject> {
    object.get(tag)?.items()?.first()
}

/// The value if it is there.
pub(super) fn required<T>(value: Result<Option<T>, Malformed>, tag: Tag) -> Result<T, Malformed> {
    value?.ok_or_else(|| Malformed(format!("{} is missing", name_of(tag))))
}

fn text_is_blank(object: &InMemDicomObject, tag: Tag) -> bool {
    object.get(tag).and_then(|element| element.to_str().ok()).is_some_and(|value| value.trim().is_empty())
}

fn malformed(object: &InMemDicomObject, tag: Tag, expected: &str) -> Malformed {
    let found = text(object, tag).unwrap_or_else(|| "no text".to_owned());
    Malformed(format!("{} is '{found}', not {expected}", name_of(tag)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dicom_core::{DataElement, VR};
    use dicom_dictionary_std::tags;

    fn with(tag: Tag, vr: VR, value: &str) -> InMemDicomObject {
        InMemDicomObject::from_element_iter([DataElement::new(tag, vr, value)])
    }

    #[test]
    fn absent_blank_and_malformed_are_told_apart() {
        let empty = InMemDicomObject::new_empty();
        assert_eq!(decimals::<3>(&empty, tags::IMAGE_POSITION_PATIENT), Ok(None), "absent");
        let blank = with(tags::IMAGE_POSITION_PATIENT, VR::DS, " ");
        assert_eq!(decimals::<3>(&blank, tags::IMAGE_POSITION_PATIENT), Ok(None), "blank");
        let good = with(tags::IMAGE_POSITION_PATIENT, VR::DS, "-1.5 \\2\\ 3e1");
        assert_eq!(decimals::<3>(&good, tags::IMAGE_POSITION_PATIENT), Ok(Some([-1.5, 2.0, 30.0])), "three numbers");
        for damaged in ["1\\2", "1\\2\\x", "1\\2\\nan", "1\\2\\3\\4"] {
            let object = with(tags::IMAGE_POSITION_PATIENT, VR::DS, damaged);
            let found = decimals::<3>(&object, tags::IMAGE_POSITION_PATIENT);
            assert!(found.is_err(), "'{damaged}': found {found:?}, expected it to be malformed");
        }
    }

    #[test]
    fn names_are_the_dictionarys() {
        assert_eq!(name_of(tags::IMAGE_POSITION_PATIENT), "ImagePositionPatient (0020,0032)");
    }
}
