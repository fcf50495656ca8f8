//! Reads and writes point sets and answers, one module per format.
