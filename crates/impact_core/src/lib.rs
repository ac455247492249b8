//! Impact of a manipulator on a human head: parameters and errors.
#![forbid(unsafe_code)]
