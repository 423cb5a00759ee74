//! Mathematics without a domain: polynomials, stable exponentials, counter-based hashes.
