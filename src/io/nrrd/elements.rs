//! The elements of an array, in the type that the file gives them.

use super::encoding::{ElementType, Endian};

/// A number as files hold it.
pub(super) trait Element: Copy {
    /// Bytes in the raw form.
    const BYTES: usize;
    /// Reads the raw form; `bytes` has the length [`Element::BYTES`].
    fn from_bytes(bytes: &[u8], endian: Endian) -> Self;
    /// Reads the decimal form.
    fn from_text(text: &str) -> Option<Self>;
}

/// Defines the ten types once, and what depends on them.
macro_rules! elements {
    ($($variant:ident $number:ty;)*) => {
        /// The elements of an array, fastest axis first.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Elements {
            $(#[doc = concat!("As `", stringify!($number), "`.")] $variant(Vec<$number>),)*
        }

        $(impl Element for $number {
            const BYTES: usize = size_of::<$number>();

            fn from_bytes(bytes: &[u8], endian: Endian) -> Self {
                let mut own = [0; size_of::<$number>()];
                own.copy_from_slice(bytes);
                match endian {
                    Endian::Little => <$number>::from_le_bytes(own),
                    Endian::Big => <$number>::from_be_bytes(own),
                }
            }

            fn from_text(text: &str) -> Option<Self> {
                text.parse().ok()
            }
        })*

        impl Elements {
            /// No elements yet, of this type.
            pub(super) fn none_of(element_type: ElementType) -> Self {
                match element_type {
                    $(ElementType::$variant => Elements::$variant(Vec::new()),)*
                }
            }

            /// Number of elements.
            pub fn len(&self) -> usize {
                match self {
                    $(Elements::$variant(values) => values.len(),)*
                }
            }

            /// True for no elements at all.
            pub fn is_empty(&self) -> bool {
                self.len() == 0
            }

            /// Type of the elements.
            pub fn element_type(&self) -> ElementType {
                match self {
                    $(Elements::$variant(_) => ElementType::$variant,)*
                }
            }
        }

        /// Runs an expression with the vector inside [`Elements`], whatever its type.
        macro_rules! with_elements {
            ($elements:expr, $values:ident => $body:expr) => {
                match $elements {
                    $(Elements::$variant($values) => $body,)*
                }
            };
        }
        pub(super) use with_elements;
    };
}

elements! {
    I8 i8;
    U8 u8;
    I16 i16;
    U16 u16;
    I32 i32;
    U32 u32;
    I64 i64;
    U64 u64;
    F32 f32;
    F64 f64;
}
