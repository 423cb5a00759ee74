//! What a ray may ask at a point: the value, its gradient, the gradient magnitude, and what blocks of cells hold.
