//! Volumes made by formula: the CT head phantom.
