//! Borders of the kind that maps hold: coasts with islands, and states whose border lines meet in threes and fours.
//!
//! A line is displaced in its middle again and again, then simplified as cartographers do: vertices are dense at bends and sparse where the
//! line is straight.

use super::{Clean, Point, Random};

/// A map: coasts or border lines.
pub fn draw(seed: u64, is_thinned: bool) -> Clean {
    let mut random = Random::of(3, seed);
    let mut chains = match seed % 2 {
        0 => coast(&mut random),
        _ => states(&mut random),
    };
    if is_thinned {
        chains = chains.into_iter().filter_map(|(chain, closed)| thinned(&chain, closed)).collect();
    }
    Clean::of(&chains, &mut random)
}

/// Every third vertex, and both ends of an open chain.
fn thinned(chain: &[Point], closed: bool) -> Option<(Vec<Point>, bool)> {
    let mut kept: Vec<Point> = chain.iter().step_by(3).copied().collect();
    if !closed && chain.len() % 3 != 1 {
        kept.push(chain[chain.len() - 1]);
    }
    (!closed || kept.len() > 3).then_some((kept, closed))
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A line from a to b (b left out), displaced down to pieces of a length.
fn displaced(
    random: &mut Random,
    a: Point,
    b: Point,
    roughness: f64,
    least: f64,
    out: &mut Vec<Point>,
) {
    let length = distance(a, b);
    if length < least {
        out.push(a);
        return;
    }
    let along = random.between(0.4, 0.6);
    // Bounded, as a line that crosses itself is no border.
    let off = roughness * random.normal().clamp(-2.0, 2.0);
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    let middle = [a[0] + along * x - off * y, a[1] + along * y + off * x];
    displaced(random, a, middle, roughness, least, out);
    displaced(random, middle, b, roughness, least, out);
}

/// The vertices that Douglas and Peucker keep, both ends among them.
fn simplified(line: &[Point], tolerance: f64, out: &mut Vec<Point>) {
    let (a, b) = (line[0], line[line.len() - 1]);
    let length = distance(a, b).max(f64::MIN_POSITIVE);
    let off =
        |p: &Point| ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).abs() / length;
    let worst = (1..line.len().saturating_sub(1))
        .max_by(|&i, &j| off(&line[i]).total_cmp(&off(&line[j])))
        .filter(|&k| off(&line[k]) > tolerance);
    match worst {
        Some(k) => {
            simplified(&line[..=k], tolerance, out);
            out.pop();
            simplified(&line[k..], tolerance, out);
        }
        None => out.extend([a, b]),
    }
}

/// Whether two edges of the chains meet but in a common end; few edges are asked.
fn crosses(chains: &[(Vec<Point>, bool)]) -> bool {
    let lines: Vec<_> = chains
        .iter()
        .map(|(vertices, closed)| taut_mesh::Polyline { vertices, closed: *closed })
        .collect();
    lines.iter().any(|line| taut_mesh::crossings(std::slice::from_ref(line)) > 0)
}

/// A closed coast around a place.
fn island(random: &mut Random, at: Point, size: f64, least: f64) -> (Vec<Point>, bool) {
    let mut roughness = random.between(0.12, 0.3);
    loop {
        let corners = 5 + random.below(8);
        let ring: Vec<Point> = (0..corners)
            .map(|k| {
                let turn = std::f64::consts::TAU * k as f64 / corners as f64;
                let r = size * random.between(0.7, 1.1);
                [at[0] + r * turn.cos(), at[1] + r * turn.sin()]
            })
            .collect();
        let mut line = vec![];
        for k in 0..corners {
            displaced(random, ring[k], ring[(k + 1) % corners], roughness, least, &mut line);
        }
        line.push(line[0]);
        // Both halves, as the ends of a ring are one point.
        let (tolerance, half) = (random.between(0.1, 0.35) * least, line.len() / 2);
        let mut kept = vec![];
        simplified(&line[..=half], tolerance, &mut kept);
        kept.pop();
        simplified(&line[half..], tolerance, &mut kept);
        kept.pop();
        let found = vec![(kept, true)];
        if !crosses(&found) {
            return found.into_iter().next().expect("one chain");
        }
        roughness *= 0.9;
    }
}

/// A mainland and islands beside it.
fn coast(random: &mut Random) -> Vec<(Vec<Point>, bool)> {
    let least = random.log_between(0.004, 0.02);
    let mut disks = vec![([0.0; 2], 1.0)];
    let mut chains = vec![island(random, [0.0; 2], 1.0, least)];
    let wanted = random.below(12);
    let mut tries = 0;
    while chains.len() <= wanted && tries < 200 {
        tries += 1;
        let size = random.log_between(0.03, 0.3);
        let at = [random.between(-2.5, 2.5), random.between(-2.5, 2.5)];
        if disks.iter().all(|&(other, radius)| distance(at, other) > 1.5 * radius + 1.6 * size) {
            disks.push((at, size));
            chains.push(island(random, at, size, least.min(size / 5.0)));
        }
    }
    chains
}

/// A jittered grid of states: each border line is a chain between two places where borders meet; some are straight.
fn states(random: &mut Random) -> Vec<(Vec<Point>, bool)> {
    let side = 3 + random.below(4);
    let cell = 1.0 / side as f64;
    let least = cell * random.log_between(0.02, 0.08);
    let roughness = random.between(0.08, 0.18);
    let mut corners = vec![];
    for i in 0..=side {
        for j in 0..=side {
            let mut off = || 0.25 * cell * random.between(-1.0, 1.0);
            corners.push([i as f64 * cell + off(), j as f64 * cell + off()]);
        }
    }
    let mut chains = vec![];
    for i in 0..=side {
        for j in 0..=side {
            for (to_i, to_j) in [(i + 1, j), (i, j + 1)] {
                // Some lines within are left out: states have several sizes.
                let is_inner = if to_i > i { j > 0 && j < side } else { i > 0 && i < side };
                if to_i > side || to_j > side || is_inner && random.is_one_of(4) {
                    continue;
                }
                let (a, b) = (corners[i * (side + 1) + j], corners[to_i * (side + 1) + to_j]);
                let mut roughness = if random.is_one_of(4) { 0.003 } else { roughness };
                loop {
                    let mut line = vec![];
                    displaced(random, a, b, roughness, least, &mut line);
                    line.push(b);
                    let mut kept = vec![];
                    simplified(&line, random.between(0.05, 0.25) * least, &mut kept);
                    let found = [(kept, false)];
                    if !crosses(&found) {
                        chains.extend(found);
                        break;
                    }
                    roughness *= 0.8;
                }
            }
        }
    }
    chains
}
