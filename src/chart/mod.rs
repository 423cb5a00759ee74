//! Charts as SVG and as pictures.
//!
//! Text is set in a font that comes along, a subset of DejaVu Sans, so that a chart is the same on a machine without fonts.
//! A program that shows the SVG picks its own sans-serif.

mod font;
mod loglog;

pub use loglog::{LogLog, Series};
