//! From SVG to the bytes of a PNG file.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::error::{Error, Fault, Result};

/// The drawing at one pixel per unit, with the one font that comes along.
pub(super) fn png(svg: &str) -> Result<Vec<u8>> {
    let internal = |what: &str| Error::new(Fault::Internal, what.to_owned());
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|cause| internal("a drawing is no SVG").caused_by(cause))?;
    let size = tree.size().to_int_size();
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or_else(|| {
        Error::new(Fault::Limit, "the chart is too large").found(format!("{} x {} pixels", size.width(), size.height()))
    })?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|cause| internal("a chart could not be encoded").caused_by(cause))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dark_pixels(svg: &str) -> usize {
        let pixels = Pixmap::decode_png(&png(svg).expect("a drawing")).expect("a PNG");
        pixels.pixels().iter().filter(|p| p.red() < 128).count()
    }

    #[test]
    fn text_is_drawn_without_a_font_of_the_system() {
        let page = |inside: &str| {
            let open = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"40\">";
            format!("{open}<rect width=\"200\" height=\"40\" fill=\"#fff\"/>{inside}</svg>")
        };
        assert_eq!(dark_pixels(&page("")), 0, "paper");
        let text = "<text x=\"5\" y=\"30\" font-family=\"DejaVu Sans\" font-size=\"24\">HU/mm −100</text>";
        let found = dark_pixels(&page(text));
        assert!((300..2000).contains(&found), "letters are {found} dark pixels");
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert_eq!(png("<svg").expect_err("not closed").fault(), Fault::Internal);
    }
}
