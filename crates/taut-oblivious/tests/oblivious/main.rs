//! Any bytes as records to sort, and threads that change no byte.

mod bytes;
mod memory_bytes;
mod threads;
