//! Measures how fast a file is read: `cargo run --release -p taut-io --example throughput -- points.csv [COLUMNS]`.
//!
//! Five times from memory, so that the disk does not count; each line is megabytes of the file per second.

use std::time::Instant;

use taut_io::{ReadOptions, open_bytes};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("name a file")?;
    let columns = arguments.next().map(|text| text.parse()).transpose()?;
    let options = ReadOptions { columns, ..Default::default() };
    let bytes = std::fs::read(&path)?;
    for _ in 0..5 {
        let copy = bytes.clone();
        let start = Instant::now();
        let input = open_bytes(copy, &path, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{:.0} MB/s, {} × {} from {:.1} MB in {:.1} ms",
            bytes.len() as f64 / 1e6 / seconds,
            input.source.len(),
            input.source.dim(),
            bytes.len() as f64 / 1e6,
            seconds * 1e3
        );
    }
    Ok(())
}
