//! OpenEXR pictures, linear f32, premultiplied alpha.
