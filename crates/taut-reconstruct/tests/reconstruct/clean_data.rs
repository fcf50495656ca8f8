//! Outlines of letters and coastlines, where the folder `TAUT_DATA` holds them under `curve/`.

use std::collections::HashSet;
use std::io::Read;
use std::path::PathBuf;

use taut_points::Points;
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

type Point = [f64; 2];

/// The text of a file, if it is there.
fn text(test: &str, name: &str) -> Option<String> {
    let folder = std::env::var_os("TAUT_DATA").map(PathBuf::from).unwrap_or_default();
    let Ok(packed) = std::fs::read(folder.join("curve").join(name)) else {
        eprintln!("skipped: {test}, as TAUT_DATA does not hold {name}");
        return None;
    };
    let mut text = String::new();
    liblzma::read::XzDecoder::new(&packed[..]).read_to_string(&mut text).expect("an xz file");
    Some(text)
}

/// Returns how many edges of closed loops are found by corners, how many there are, and how many are found beside them.
fn score(loops: &[Vec<Point>]) -> [usize; 3] {
    let key = |a: Point, b: Point| {
        let [a, b] = [a, b].map(|p| p.map(|x| (x + 0.0).to_bits()));
        (a.min(b), a.max(b))
    };
    let around = |vertices: &[Point], closed: bool| -> Vec<_> {
        let count = vertices.len() - usize::from(!closed);
        let next = vertices.iter().cycle().skip(1);
        vertices.iter().zip(next).take(count).map(|(&a, &b)| key(a, b)).collect()
    };
    let mut truth: HashSet<_> = loops.iter().flat_map(|ring| around(ring, true)).collect();
    truth.retain(|(a, b)| a != b);
    let flat: Vec<f64> = loops.iter().flatten().flatten().copied().collect();
    let points = Points::new(&flat, 2).expect("whole rows");
    let options = CurveOptions { method: CurveMethod::Corners, ..Default::default() };
    let found = curve(&points, &options).expect("finite points").answer;
    let edges: Vec<_> = found.curves.iter().flat_map(|c| around(&c.vertices, c.closed)).collect();
    let right = edges.iter().filter(|edge| truth.contains(edge)).count();
    [right, truth.len(), edges.len() - right]
}

#[test]
fn nine_of_ten_edges_of_coastlines() {
    let test = "nine_of_ten_edges_of_coastlines";
    let Some(text) = text(test, "naturalearth_land_10m.loops.txt.xz") else { return };
    let mut loops: Vec<Vec<Point>> = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace().map(|word| word.parse::<f64>().expect("numbers"));
        let mut next = || words.next().expect("three numbers");
        let [number, x, y] = [next(), next(), next()];
        loops.resize_with(loops.len().max(number as usize + 1), Vec::new);
        loops[number as usize].push([x, y]);
    }
    let [right, all, wrong] = score(&loops);
    assert_eq!(all, 404_566);
    assert!(100 * right >= 92 * all && 100 * wrong <= 7 * all, "{right} of {all}, {wrong} wrong");
}

/// The stem of the small letter l is 184 of the units of this font, 2048 to an em; samples are an eighth of it apart.
const SPACING: f64 = 184.0 / 8.0;

#[test]
fn outlines_of_letters_are_found_whole() {
    let test = "outlines_of_letters_are_found_whole";
    let Some(text) = text(test, "dejavu_serif_glyphs.quad.txt.xz") else { return };
    let mut glyphs: Vec<(String, Vec<Vec<Point>>)> = Vec::new();
    let (mut pieces, mut here): (Vec<Vec<Point>>, Point) = (Vec::new(), [0.0; 2]);
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let numbers: Vec<f64> = rest.split(' ').filter_map(|word| word.parse().ok()).collect();
        let mut points: Vec<Point> = numbers.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
        match word {
            "glyph" => glyphs.push((rest.into(), Vec::new())),
            "M" => here = points[0],
            "Z" => {
                let start = pieces[0][0];
                if here != start {
                    pieces.push(vec![here, start]);
                }
                let contour = sampled(&std::mem::take(&mut pieces));
                glyphs.last_mut().expect("a glyph was named").1.push(contour);
            }
            _ => {
                points.insert(0, here);
                here = points[points.len() - 1];
                points.dedup();
                if points.len() > 1 {
                    pieces.push(points);
                }
            }
        }
    }
    let whole = |loops: &[Vec<Point>]| {
        let [right, all, wrong] = score(loops);
        right == all && wrong == 0
    };
    let broken: Vec<&String> = glyphs.iter().filter(|(_, l)| !whole(l)).map(|(n, _)| n).collect();
    assert_eq!(glyphs.len(), 214);
    assert!(broken.len() <= 4, "{broken:?}");
}

fn distance(a: Point, b: Point) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Points at equal distances of at most [`SPACING`] along a contour, from each corner to the next; corners, where the tangent turns by
/// more than 10°, are among them.
fn sampled(pieces: &[Vec<Point>]) -> Vec<Point> {
    let along = |a: Point, b: Point| [0, 1].map(|i| (b[i] - a[i]) / distance(a, b));
    let corner = |i: usize| {
        let before = &pieces[(i + pieces.len() - 1) % pieces.len()];
        let arrives = along(before[before.len() - 2], before[before.len() - 1]);
        let leaves = along(pieces[i][0], pieces[i][1]);
        arrives[0] * leaves[0] + arrives[1] * leaves[1] < 10f64.to_radians().cos()
    };
    let corners: Vec<usize> = (0..pieces.len()).filter(|&i| corner(i)).collect();
    let corners = if corners.is_empty() { vec![0] } else { corners };
    let mut samples = Vec::new();
    for (k, &first) in corners.iter().enumerate() {
        let last = corners.get(k + 1).copied().unwrap_or(corners[0] + pieces.len());
        let mut fine = vec![pieces[first][0]];
        for i in first..last {
            let piece = &pieces[i % pieces.len()];
            let steps = if piece.len() == 2 { 1 } else { 200 };
            fine.extend((1..=steps).map(|step| at(piece, f64::from(step) / f64::from(steps))));
        }
        let length: f64 = fine.windows(2).map(|ends| distance(ends[0], ends[1])).sum();
        let count = (length / SPACING).ceil().max(1.0);
        let (mut done, mut given) = (0.0, 0.0);
        for ends in fine.windows(2) {
            let step = distance(ends[0], ends[1]);
            while given < count && length * given / count <= done + step - 1e-9 {
                let t = (length * given / count - done) / step;
                samples.push([0, 1].map(|i| ends[0][i] + t * (ends[1][i] - ends[0][i])));
                given += 1.0;
            }
            done += step;
        }
    }
    samples
}

/// A point of a line or of a quadratic curve.
fn at(piece: &[Point], t: f64) -> Point {
    let mix = |a: Point, b: Point| [0, 1].map(|i| a[i] + t * (b[i] - a[i]));
    match piece {
        [a, b, c] => mix(mix(*a, *b), mix(*b, *c)),
        _ => piece[piece.len() - 1],
    }
}
