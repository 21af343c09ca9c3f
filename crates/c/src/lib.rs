//! The core for C: plain functions, and those of the Functional Mock-up Interface.
//!
//! | module        | responsibility                                                            |
//! |---------------|---------------------------------------------------------------------------|
//! | `variables`   | the one table of variables: names, numbers, units, what they are          |
//! | `description` | the text that describes a drive, read and checked                         |
//! | `making`      | the core's objects of a described drive                                   |
//! | `account`     | ways, work and heat, which add up along a motion                          |
//! | `measured`    | whether a motion is still where its law was measured                      |
//! | `instance`    | one drive under way: phase, values, motion, and what of that can be seen  |
//! | `saving`      | a saved instance as bytes                                                 |
//! | `memory`      | memory of the caller, read and written                                    |
//! | `handle`      | what a caller holds; where words to it go; no panic passes                |
//! | `plain`       | plain functions, those of `include/hersey.h`                              |
//! | `exchange`    | what both versions of the Functional Mock-up Interface share              |
//! | `fmi2`        | its version 2.0                                                           |
//! | `fmi3`        | its version 3.0                                                           |
//!
//! Nothing here is physics: the motion is that of `hersey_core::motion::Stepper`.

mod account;
mod description;
mod exchange;
mod fmi2;
mod fmi3;
mod handle;
mod instance;
mod making;
mod measured;
mod memory;
mod plain;
mod saving;
mod variables;

#[cfg(test)]
mod samples;
