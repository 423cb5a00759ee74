//! Polynomials in Bernstein form.
