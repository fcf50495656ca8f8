//! Touching pairs of balls by the hierarchy of boxes of parry3d, in the protocol of `bench/peers/protocol.hpp`.
//!
//! Times are processor time of the process, which has one thread. The seconds are those of the pairs, from the tree to a sorted list; the radius is the seconds of building the tree.

use std::error::Error;
use std::io::stdin;

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

use crate::meter::Meter;
use crate::shapes::rows;

/// Answers each line of standard input with a line, and `output` with the pairs, sorted.
pub fn serve(path: &str, output: &str) -> Result<(), Box<dyn Error>> {
    let balls: Vec<[f64; 4]> = rows(path)?;
    println!("{{\"ready\":true}}");
    for line in stdin().lines() {
        line?;
        let meter = Meter::start();
        let boxes: Vec<Aabb> = balls.iter().map(|&ball| bounding_box(ball)).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let build = meter.stop().cpu;
        let meter = Meter::start();
        let mut pairs: Vec<[u32; 2]> = vec![];
        let mut workspace = BvhWorkspace::default();
        tree.traverse_bvtt_single_tree::<false>(&mut workspace, &mut |a, b| {
            if touch(balls[a as usize], balls[b as usize]) {
                pairs.push([a.min(b), a.max(b)]);
            }
        });
        pairs.sort_unstable();
        let seconds = meter.stop().cpu;
        let bytes = pairs.as_flattened().iter().flat_map(|&row| f64::from(row).to_le_bytes());
        std::fs::write(output, bytes.collect::<Vec<u8>>())?;
        println!("{{\"seconds\":{seconds},\"radius\":{build},\"support\":0}}");
    }
    Ok(())
}

fn bounding_box([x, y, z, r]: [f64; 4]) -> Aabb {
    Aabb::new(Vector::new(x - r, y - r, z - r), Vector::new(x + r, y + r, z + r))
}

/// The same test as that of taut, so that the pairs can be compared one by one.
fn touch(p: [f64; 4], q: [f64; 4]) -> bool {
    let along = |axis: usize| (p[axis] - q[axis]) * (p[axis] - q[axis]);
    ((along(0) + along(1)) + along(2)).sqrt() - (p[3] + q[3]) <= 0.0
}
