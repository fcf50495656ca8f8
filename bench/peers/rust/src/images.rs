//! imageproc in the protocol of `bench/peers/protocol.hpp`: the squared distances of the pixels that are 1 to the nearest one that is 0.

use std::error::Error;
use std::io::stdin;
use std::time::Instant;

use imageproc::distance_transform::euclidean_squared_distance_transform;
use imageproc::image::GrayImage;

/// Answers each line of standard input with a line, and `output` with the distances, row by row.
pub fn serve(path: &str, output: &str) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let (words, _) = bytes.as_chunks::<8>();
    let [height, width, pixels @ ..] = words else { return Err("no header".into()) };
    let [height, width] = [height, width].map(|&word| u64::from_le_bytes(word) as u32);
    // It measures to the nearest pixel that is not 0.
    let outside = pixels.iter().map(|&word| u8::from(f64::from_le_bytes(word) == 0.0) * 255);
    let image = GrayImage::from_raw(width, height, outside.collect()).ok_or("too few pixels")?;
    println!("{{\"ready\":true}}");
    for line in stdin().lines() {
        line?;
        let start = Instant::now();
        let squared = euclidean_squared_distance_transform(&image);
        let seconds = start.elapsed().as_secs_f64();
        let largest = squared.iter().copied().fold(0.0, f64::max);
        std::fs::write(output, squared.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())?;
        println!("{{\"seconds\":{seconds},\"radius\":{largest},\"support\":0}}");
    }
    Ok(())
}
