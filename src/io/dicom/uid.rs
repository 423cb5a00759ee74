//! Unique identifiers that are the same for the same content: PS3.5 §B.2.

use sha2::{Digest as _, Sha256};

/// Implementation Class UID of files written by pellucid (PS3.7 §D.3.3.2), made as the others are.
pub(super) fn implementation_class() -> String {
    Seed::of(&[b"pellucid"]).uid("implementation", 0)
}

/// The hash from which the identifiers of one series are derived.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seed([u8; 32]);

impl Seed {
    /// Of these pieces of content, in order.
    pub(super) fn of(pieces: &[&[u8]]) -> Self {
        let mut hash = Sha256::new();
        for piece in pieces {
            hash.update((piece.len() as u64).to_le_bytes());
            hash.update(piece);
        }
        Seed(hash.finalize().into())
    }

    /// The identifier of one thing: `2.25.` and a UUID as a decimal number.
    pub(super) fn uid(&self, what: &str, index: u64) -> String {
        let hash = Sha256::new().chain_update(self.0).chain_update(what).chain_update(index.to_le_bytes()).finalize();
        let mut uuid = [0; 16];
        uuid.copy_from_slice(&hash[..16]);
        // Version 8 (vendor-specific) and the variant of RFC 9562, so that the number is a UUID indeed.
        uuid[6] = uuid[6] & 0x0F | 0x80;
        uuid[8] = uuid[8] & 0x3F | 0x80;
        format!("2.25.{}", u128::from_be_bytes(uuid))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_valid_distinct_and_repeatable() {
        let seed = Seed::of(&[b"a", b"bc"]);
        let uid = seed.uid("image", 3);
        assert!(uid.len() <= 64 && uid.starts_with("2.25."), "found {uid}");
        assert!(uid.bytes().all(|b| b.is_ascii_digit() || b == b'.'), "found {uid}");
        assert_eq!(uid, Seed::of(&[b"a", b"bc"]).uid("image", 3), "the same content");
        assert_ne!(uid, seed.uid("image", 4), "another image");
        assert_ne!(uid, Seed::of(&[b"ab", b"c"]).uid("image", 3), "other pieces of the same bytes");
    }
}
