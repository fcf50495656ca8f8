//! Sets of pixels against the definitions: opening, components and holes by flood fill, and the boundary of the thesis.

use taut_recognize::hand::color::ThresholdTable;
use taut_recognize::hand::components::largest_component;
use taut_recognize::hand::mask::Mask;
use taut_recognize::hand::thesis::thesis_boundary;

/// The next number of a linear congruential generator, its high bits.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

/// A random set in which pixels come in blocks, so that it has runs, holes and pieces; wider than a word at times.
fn random_mask(state: &mut u64) -> Mask {
    let (width, height) = (1 + next(state) as usize % 140, 1 + next(state) as usize % 24);
    let density = next(state) % 1024;
    let block = 1 + next(state) as usize % 5;
    let columns = width.div_ceil(block);
    let bits: Vec<bool> =
        (0..columns * height.div_ceil(block)).map(|_| next(state) % 1024 < density).collect();
    Mask::from_fn(width, height, |x, y| bits[y / block * columns + x / block])
}

const EDGES: [[i64; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
const CORNERS: [[i64; 2]; 4] = [[1, 1], [-1, 1], [-1, -1], [1, -1]];

/// Returns the pixels connected to a start within the image, by flood fill.
fn flood(
    mask: &Mask,
    start: [i64; 2],
    is_set: bool,
    steps: &[[i64; 2]],
    seen: &mut [bool],
) -> Vec<[i64; 2]> {
    let (width, height) = (mask.width() as i64, mask.height() as i64);
    let (mut found, mut waiting) = (vec![], vec![start]);
    while let Some([x, y]) = waiting.pop() {
        let is_inside = x >= 0 && y >= 0 && x < width && y < height;
        if !is_inside || mask.contains(x, y) != is_set || seen[(y * width + x) as usize] {
            continue;
        }
        seen[(y * width + x) as usize] = true;
        found.push([x, y]);
        waiting.extend(steps.iter().map(|[u, v]| [x + u, y + v]));
    }
    found
}

/// Returns all components of a set or of its complement.
fn pieces(mask: &Mask, is_set: bool) -> Vec<Vec<[i64; 2]>> {
    let (width, height) = (mask.width() as i64, mask.height() as i64);
    let steps = if is_set { EDGES.to_vec() } else { [EDGES, CORNERS].concat() };
    let mut seen = vec![false; (width * height) as usize];
    let starts = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    starts
        .map(|start| flood(mask, start, is_set, &steps, &mut seen))
        .filter(|piece| !piece.is_empty())
        .collect()
}

#[test]
fn components_and_holes_are_those_of_a_flood_fill() {
    let mut state = 3;
    let mut holes = 0;
    for round in 0..2000 {
        let mask = random_mask(&mut state);
        let wanted = pieces(&mask, true);
        let Some(found) = largest_component(&mask) else {
            assert!(wanted.is_empty());
            continue;
        };
        let largest = wanted.iter().map(Vec::len).max().expect("there is a component");
        let mut areas: Vec<u64> = wanted.iter().map(|piece| piece.len() as u64).collect();
        areas.sort_unstable();
        areas.pop();
        areas.reverse();
        let others: Vec<u64> = found.others.iter().map(|other| other.area).collect();
        assert_eq!(others, areas, "round {round}");
        // The first of the largest, and the pieces of its complement that do not reach the border.
        let piece = wanted.iter().find(|piece| piece.len() == largest).expect("one is largest");
        let (width, height) = (mask.width() as i64, mask.height() as i64);
        let only = Mask::from_fn(mask.width(), mask.height(), |x, y| {
            piece.contains(&[x as i64, y as i64])
        });
        let is_hole = |piece: &Vec<[i64; 2]>| {
            piece.iter().all(|&[x, y]| x > 0 && y > 0 && x + 1 < width && y + 1 < height)
        };
        let filled: Vec<_> = pieces(&only, false).into_iter().filter(is_hole).collect();
        holes += filled.len();
        let sum = filled.iter().map(Vec::len).sum::<usize>() + largest;
        assert_eq!((found.area, found.mask.count()), (sum as u64, sum as u64), "round {round}");
        assert_eq!(found.holes.len(), filled.len());
        assert!(
            piece.iter().chain(filled.iter().flatten()).all(|&[x, y]| found.mask.contains(x, y))
        );
    }
    assert!(holes > 100, "{holes} holes");
}

#[test]
fn a_mask_of_tiles_is_that_of_its_pixels() {
    let mut state = 6;
    let tables = [ThresholdTable::new(4.0), ThresholdTable::new(60.0)];
    for round in 0..200 {
        let (width, height) =
            (1 + next(&mut state) as usize % 150, 1 + next(&mut state) as usize % 40);
        // Areas of skin and of lid with noise, so that there are tiles of all three kinds.
        let edge = next(&mut state) as usize % 150;
        let noise = 1 + next(&mut state) % 40;
        let pixels: Vec<u8> = (0..width * height)
            .flat_map(|k| {
                let color = if k % width < edge { [200, 160, 130] } else { [240, 242, 248] };
                color.map(|level: u64| (level + next(&mut state) % noise).min(255) as u8)
            })
            .collect();
        for table in &tables {
            let found = Mask::from_rgb(&pixels, width, height, table);
            let wanted = Mask::from_fn(width, height, |x, y| {
                let at = 3 * (y * width + x);
                table.is_above([pixels[at], pixels[at + 1], pixels[at + 2]])
            });
            assert_eq!(found, wanted, "round {round}");
        }
    }
}

#[test]
fn an_opening_is_the_union_of_the_diamonds_that_fit() {
    let mut state = 4;
    for round in 0..400 {
        let mask = random_mask(&mut state);
        let radius = 1 + round % 3;
        let found = mask.opened(radius);
        let (width, height, reach) = (mask.width() as i64, mask.height() as i64, radius as i64);
        let is_in_image = |x: i64, y: i64| x >= 0 && y >= 0 && x < width && y < height;
        let diamond = |x: i64, y: i64| {
            (-reach..=reach).flat_map(move |v| {
                let side = reach - v.abs();
                (-side..=side).map(move |u| [x + u, y + v])
            })
        };
        let fits =
            |x: i64, y: i64| diamond(x, y).all(|[u, v]| !is_in_image(u, v) || mask.contains(u, v));
        for y in 0..height {
            for x in 0..width {
                let wanted = diamond(x, y).any(|[u, v]| is_in_image(u, v) && fits(u, v));
                assert_eq!(found.contains(x, y), wanted, "round {round}, pixel {x} {y}");
            }
        }
    }
}

#[test]
fn the_thesis_boundary_is_a_cycle_without_chords() {
    let mut state = 5;
    let mut closed = 0;
    for round in 0..300 {
        // Some overlapping discs.
        let discs: Vec<[f64; 3]> = (0..3 + next(&mut state) % 6)
            .map(|_| {
                let mut share = || next(&mut state) as f64 / (1u64 << 31) as f64;
                [20.0 + 40.0 * share(), 20.0 + 40.0 * share(), 4.0 + 12.0 * share()]
            })
            .collect();
        let mask = Mask::from_fn(80, 80, |x, y| {
            discs.iter().any(|[u, v, r]| (x as f64 - u).powi(2) + (y as f64 - v).powi(2) <= r * r)
        });
        let Some(found) = largest_component(&mask.opened(2)) else { continue };
        let Some(curve) = thesis_boundary(&found.mask) else { continue };
        closed += 1;
        // It begins at the right-most pixel, and the shoelace sum of a counterclockwise curve on the screen, where y
        // goes down, is negative.
        let right = curve.iter().map(|[x, _]| *x).max().expect("a curve has pixels");
        assert_eq!(curve[0][0], right, "round {round}");
        let doubled: i64 = (0..curve.len())
            .map(|k| {
                let (a, b) = (curve[k], curve[(k + 1) % curve.len()]);
                a[0] * b[1] - a[1] * b[0]
            })
            .sum();
        assert!(doubled < 0, "round {round}: {doubled}");
        for (k, a) in curve.iter().enumerate() {
            assert!(found.mask.contains(a[0], a[1]));
            // Each pixel touches the one before and the one after, and no other.
            let touching = curve
                .iter()
                .enumerate()
                .filter(|(j, b)| *j != k && (a[0] - b[0]).abs() <= 1 && (a[1] - b[1]).abs() <= 1)
                .count();
            assert_eq!(touching, 2, "round {round}, pixel {k}");
        }
    }
    assert!(closed > 250, "{closed} closed boundaries");
}
