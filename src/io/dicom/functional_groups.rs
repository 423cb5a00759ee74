//! Attributes of one frame of a multi-frame image: PS3.3 §C.7.6.16.
//!
//! An enhanced CT image keeps position, orientation, spacing and rescale of its frames in functional groups. Each group is
//! a sequence of one item, found in the frame's own item or, if all frames agree, in the shared one; the image of a single
//! frame has the same attributes at the root. [`FrameAttributes`] looks in these places in this order.

use dicom_core::Tag;
use dicom_dictionary_std::tags;
use dicom_object::InMemDicomObject;

use super::attributes::first_item;

/// Where to look for the attributes of one frame.
pub(super) struct FrameAttributes<'a> {
    root: &'a InMemDicomObject,
    own: Option<&'a InMemDicomObject>,
    shared: Option<&'a InMemDicomObject>,
}

impl<'a> FrameAttributes<'a> {
    /// Of frame `index`, counted from 0.
    pub(super) fn of(root: &'a InMemDicomObject, index: usize) -> Self {
        let own = root
            .get(tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE)
            .and_then(|sequence| sequence.items())
            .and_then(|items| items.get(index));
        FrameAttributes { root, own, shared: first_item(root, tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE) }
    }

    /// The data set that holds this functional group's attributes; the root where there is no such group.
    pub(super) fn group(&self, sequence: Tag) -> &'a InMemDicomObject {
        let find = |groups: Option<&'a InMemDicomObject>| groups.and_then(|groups| first_item(groups, sequence));
        find(self.own).or_else(|| find(self.shared)).unwrap_or(self.root)
    }
}
