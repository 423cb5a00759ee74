//! What will be done: a spec and the metadata of a volume, resolved until no option is left open.

mod method;

pub use method::{Colors, Emission, Exact, Jitter, JitterKind, Lattice, March, Method, Order, SampleRule};
