//! The oracle is the truth the integrators are held against; here it is held against closed forms, against itself by
//! other ways, and against values computed elsewhere to 30 digits.

mod closed_forms;
mod consistency;
mod golden;
