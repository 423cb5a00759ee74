//! The font of all charts.

use std::sync::LazyLock;

use plotters::style::{FontStyle, register_font};

use crate::error::{Error, Fault, Result};

/// Name of the font, in charts and in SVG.
pub(super) const FAMILY: &str = "sans-serif";

/// Latin letters, digits and signs of DejaVu Sans 2.37; its licence lies beside it.
static BYTES: &[u8] = include_bytes!("DejaVuSans-subset.ttf");

static REGISTERED: LazyLock<bool> = LazyLock::new(|| register_font(FAMILY, FontStyle::Normal, BYTES).is_ok());

/// Makes the font known, once per process, in place of those of the system.
///
/// # Errors
/// `Fault::Internal` if the font is damaged.
pub(super) fn register() -> Result<()> {
    match *REGISTERED {
        true => Ok(()),
        false => Err(Error::new(Fault::Internal, "the font of the charts is damaged")),
    }
}
