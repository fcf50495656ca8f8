//! Writes a laser scan and what taut reads of it, for another reader to judge:
//! `cargo run --release -p taut-io --example laz -- POINTS scan.laz read.npy`.
//!
//! The coordinates are spread over all 32 bits of the file's whole numbers, with scales and offsets that no double holds exactly.
//! `read.npy` has n × 3 doubles. In Python, with laspy and lazrs:
//!
//! ```text
//! judged = laspy.read("scan.laz"); ours = numpy.load("read.npy")
//! assert (numpy.stack([judged.x, judged.y, judged.z], axis=1).view("u8") == ours.view("u8")).all()
//! ```

use std::path::Path;

use las::point::{Classification, Format};
use las::{Builder, Point, Transform, Vector, Writer};
use taut_io::{ReadOptions, open, write_points};
use taut_points::Monitor;

const SCALES: [f64; 3] = [0.001, 0.01, 0.0001];
const OFFSETS: [f64; 3] = [481_234.567, -5_432_100.1, 77.7];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut next = || arguments.next().ok_or("name the number of points, a .laz and a .npy file");
    let (points, scan, read) = (next()?.parse::<u64>()?, next()?, next()?);

    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(6)?;
    builder.point_format.is_compressed = scan.ends_with(".laz");
    let [x, y, z] = [0, 1, 2].map(|k| Transform { scale: SCALES[k], offset: OFFSETS[k] });
    builder.transforms = Vector { x, y, z };
    let mut writer = Writer::from_path(&scan, builder.into_header()?)?;
    let mut state = 1u64;
    for i in 0..points {
        let mut coordinate = |k: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            // Whole numbers of up to 31 bits and a sign, as the file has them.
            f64::from((state >> 32) as u32 as i32) * SCALES[k] + OFFSETS[k]
        };
        let [x, y, z] = [coordinate(0), coordinate(1), coordinate(2)];
        let classification = Classification::new([2, 9, 6][(i % 3) as usize])?;
        writer.write_point(Point {
            x,
            y,
            z,
            classification,
            gps_time: Some(i as f64),
            ..Point::default()
        })?;
    }
    writer.close()?;

    let input = open(Path::new(&scan), &ReadOptions::default())?;
    write_points(&*input.source, &[], Path::new(&read), None, &Monitor::silent())?;
    println!("{} points", input.source.len());
    Ok(())
}
