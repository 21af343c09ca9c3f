//! The core for C: plain functions, and those of the Functional Mock-up Interface.
