//! From a spec to a picture: load, plan, integrate, encode.
