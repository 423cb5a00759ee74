//! Transfer syntaxes: what they are called, and which of them this build decodes.

use dicom_encoding::TransferSyntaxIndex as _;
use dicom_encoding::transfer_syntax::Codec;
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

/// Name and UID, such as `RLE Lossless (1.2.840.10008.1.2.5)`.
pub(super) fn name(uid: &str) -> String {
    match TransferSyntaxRegistry.get(uid) {
        Some(syntax) => format!("{} ({uid})", syntax.name()),
        None => format!("unknown transfer syntax ({uid})"),
    }
}

/// True if this build turns its pixel data into pixels.
pub(super) fn can_decode(uid: &str) -> bool {
    TransferSyntaxRegistry.get(uid).is_some_and(|syntax| syntax.can_decode_all())
}

/// True if pixels are stored as they are, possibly in a deflated data set.
pub(super) fn is_native(uid: &str) -> bool {
    TransferSyntaxRegistry.get(uid).is_some_and(|syntax| !syntax.is_encapsulated_pixel_data())
}

/// True if the data set is not deflated, so that a file is at least as long as its uncompressed pixels.
pub(super) fn is_plain(uid: &str) -> bool {
    TransferSyntaxRegistry.get(uid).is_some_and(|syntax| matches!(syntax.codec(), Codec::None))
}
