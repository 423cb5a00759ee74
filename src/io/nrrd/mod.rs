//! NRRD: the whole format, read and written (teem.sourceforge.net/nrrd/format.html).
