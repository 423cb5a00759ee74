//! Which format a file has, and what the readers share.

use std::path::Path;

use serde_json::Value;

use super::volume_property::VolumeProperty;
use super::{paraview, presets_xml, vp, vp_json};
use crate::error::{Error, Fault, Result, TextPlace};

/// Larger than any collection of presets.
const MOST_BYTES: u64 = 4 << 20;

/// The volume properties of a `.vp`, `.vp.json`, `.xml`, `.mrml` or ParaView `.json` file.
///
/// # Errors
/// `Fault::Input`, naming line or element, for a file that cannot be read or is damaged; `Fault::Unsupported` for what has no
/// equal here.
pub fn read(path: &Path) -> Result<Vec<VolumeProperty>> {
    let unreadable = |cause: std::io::Error| {
        Error::new(Fault::Input, "the file cannot be read").at(path).caused_by(cause).remedy("check the path")
    };
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > MOST_BYTES {
        let error = Error::new(Fault::Input, "the file is too large to hold presets").at(path);
        return Err(error.found(format!("{size} bytes")).expected(format!("at most {MOST_BYTES}")));
    }
    let text = std::fs::read_to_string(path).map_err(unreadable)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    match name.rsplit('.').next().unwrap_or_default() {
        "vp" => Ok(vec![vp::read(path, &text)?]),
        "xml" | "mrml" => presets_xml::read(path, &text),
        "json" if name.ends_with(".vp.json") || is_volume_property(&text) => vp_json::read(path, &text),
        "json" => paraview::read(path, &text),
        _ => Err(Error::new(Fault::Input, "the suffix says no format of presets")
            .at(path)
            .expected(".vp, .vp.json, .xml, .mrml, or .json of ParaView")),
    }
}

/// Both programs write `.json`, and one key tells them apart.
fn is_volume_property(text: &str) -> bool {
    serde_json::from_str(text).is_ok_and(|tree: Value| tree.get("volumeProperties").is_some())
}

/// What a file without a name of its own is called: `ct-bone` for `ct-bone.vp.json`.
pub(super) fn named_after(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stem = [".vp.json", ".vp", ".json"].iter().find_map(|suffix| name.strip_suffix(suffix));
    stem.unwrap_or(&name).to_owned()
}

/// JSON that is none, or not of the form, with the place where that shows.
pub(super) fn syntax_error(path: &Path, text: &str, cause: serde_json::Error) -> Error {
    let (line, column) = (cause.line().max(1), cause.column().max(1));
    let place = TextPlace { line, column, span: None, text: text.to_owned() };
    let message = cause.to_string();
    let what = message.split(" at line ").next().unwrap_or(&message).to_owned();
    Error::new(Fault::Input, format!("this is not of the form: {what}")).at(path).place(place)
}
