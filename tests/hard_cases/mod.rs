//! One named test per hard case of the numerics.
