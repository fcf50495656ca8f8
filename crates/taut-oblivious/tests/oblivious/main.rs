//! Any bytes as records to sort, threads that change no byte, and the judgment of the checkers of files.

mod bytes;
mod certified;
mod memory_bytes;
mod test_length;
mod threads;
