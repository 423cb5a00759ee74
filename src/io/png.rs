//! PNG pictures, sRGB, 8 or 16 bits, straight alpha.
