//! Concorde's Lin-Kernighan in the protocol of `protocol.hpp`: `tours INPUT CENTER`, points of the plane that are whole
//! numbers.
//!
//! What goes to CENTER is the order of the rows, as doubles. Seconds are those of the search alone, without the matrix of
//! distances, which takes n² / 2 numbers.
#![forbid(unsafe_code)]

use std::time::Instant;

use concorde_rs::{Distance, LowerDistanceMatrix, solver};

/// A place; lengths are rounded as in TSPLIB.
struct Place([f64; 2]);

impl Distance for Place {
    fn calc_shortest_dist(&self, other: &Self) -> u32 {
        let [x, y] = [0, 1].map(|k| self.0[k] - other.0[k]);
        x.hypot(y).round() as u32
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, input, center] = &arguments[..] else {
        return Err("expected INPUT and CENTER".into());
    };
    let bytes = std::fs::read(input)?;
    let (words, _) = bytes.as_chunks::<8>();
    let values: Vec<f64> = words.iter().skip(2).map(|word| f64::from_le_bytes(*word)).collect();
    let places: Vec<Place> =
        values.chunks_exact(2).map(|place| Place([place[0], place[1]])).collect();
    let matrix = LowerDistanceMatrix::from(&places[..]);
    println!("{{\"ready\":true}}");
    for line in std::io::stdin().lines() {
        line?;
        let start = Instant::now();
        let found = solver::tsp_lk(&matrix)?;
        let seconds = start.elapsed().as_secs_f64();
        let order: Vec<u8> =
            found.tour.iter().flat_map(|&row| f64::from(row).to_le_bytes()).collect();
        std::fs::write(center, order)?;
        println!("{{\"seconds\":{seconds},\"radius\":{}}}", found.length);
    }
    Ok(())
}
