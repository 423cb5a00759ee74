//! `presets.xml`, and scenes in MRML: `VolumeProperty` elements with the lines of a `.vp` file as attributes.

use std::path::Path;

use roxmltree::{Attribute, Document, Node};

use super::function::Function;
use super::numbers::counted;
use super::volume_property::{Phong, VolumeProperty};
use crate::error::{Error, Fault, Result, TextPlace};

pub(super) fn read(path: &Path, text: &str) -> Result<Vec<VolumeProperty>> {
    let document = Document::parse(text).map_err(|error| {
        let position = error.pos();
        let place = place(text, position.row, position.col);
        Error::new(Fault::Input, "this is not valid XML").at(path).place(place).caused_by(error)
    })?;
    let nodes = document.descendants().filter(|node| node.has_tag_name("VolumeProperty"));
    let properties = nodes.map(|node| Element { node, path, text }.property()).collect::<Result<Vec<_>>>()?;
    if properties.is_empty() {
        let error = Error::new(Fault::Input, "there is no volume property in this file").at(path);
        return Err(error.expected("elements <VolumeProperty …/>"));
    }
    Ok(properties)
}

fn place(text: &str, line: u32, column: u32) -> TextPlace {
    // 32 bits count the lines of any file that is read.
    TextPlace { line: line as usize, column: column as usize, span: None, text: text.to_owned() }
}

/// An element, for errors with its place.
struct Element<'a, 'input> {
    node: Node<'a, 'input>,
    path: &'a Path,
    text: &'a str,
}

impl<'a, 'input> Element<'a, 'input> {
    fn property(&self) -> Result<VolumeProperty> {
        let shade = self.number("shade", 0.0)? != 0.0;
        let shading = Phong {
            ambient: self.number("ambient", 0.1)?,
            diffuse: self.number("diffuse", 0.9)?,
            specular: self.number("specular", 0.2)?,
            shininess: self.number("specularPower", 10.0)?,
        };
        let gradient = self.attribute("gradientOpacity").is_some();
        Ok(VolumeProperty {
            name: self.node.attribute("name").unwrap_or("volume-property").to_owned(),
            scalar_opacity: self.function("scalarOpacity")?,
            gradient_opacity: gradient.then(|| self.function("gradientOpacity")).transpose()?,
            color: self.function("colorTransfer")?,
            unit_distance_mm: None,
            shading: shade.then_some(shading),
        })
    }

    fn attribute(&self, name: &str) -> Option<Attribute<'a, 'input>> {
        self.node.attributes().find(|attribute| attribute.name() == name)
    }

    fn function<const N: usize>(&self, name: &str) -> Result<Function<N>> {
        let attribute = self.attribute(name).ok_or_else(|| {
            let error = Error::new(Fault::Input, "an attribute is missing").expected(name);
            self.located(error, name, self.node.range().start)
        })?;
        counted(attribute.value()).map_err(|error| self.located(error, name, attribute.range().start))
    }

    fn number(&self, name: &str, default: f64) -> Result<f64> {
        let Some(attribute) = self.attribute(name) else { return Ok(default) };
        let number = attribute.value().trim().parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0);
        number.ok_or_else(|| {
            let error = Error::new(Fault::Input, "an attribute holds no number").found(attribute.value());
            self.located(error, name, attribute.range().start)
        })
    }

    fn located(&self, error: Error, attribute: &str, offset: usize) -> Error {
        let position = self.node.document().text_pos_at(offset);
        let name = self.node.attribute("name").unwrap_or("without a name");
        error.at(self.path).element(format!("VolumeProperty {name}, {attribute}")).place(place(
            self.text,
            position.row,
            position.col,
        ))
    }
}
