//! Outlines whose truth is known: coastlines and glyphs of `$TAUT_DATA/curve`.

use super::*;

/// Methods beside each other; the first is the default.
const METHODS: [CurveMethod; 5] = [
    CurveMethod::Auto,
    CurveMethod::Corners,
    CurveMethod::NnCrust,
    CurveMethod::HnnCrust,
    CurveMethod::OneStepCrust,
];

/// A closed outline.
type Ring = Vec<[f64; 2]>;

/// Vertices of rings, shuffled, with the edges between them. Vertices at one place count as one.
struct Shuffled {
    points: Vec<f64>,
    edges: Vec<[u64; 2]>,
    /// The first row at the place of each row.
    first: Vec<u64>,
}

impl Shuffled {
    fn new(rings: &[Ring], seed: u64) -> Result<Self> {
        let count: usize = rings.iter().map(Vec::len).sum();
        let order = shuffled(count, seed)?;
        let vertices: Vec<[f64; 2]> = rings.concat();
        let points: Vec<f64> = order.iter().flat_map(|&at| vertices[at]).collect();
        let mut rows: HashMap<[u64; 2], u64> = HashMap::new();
        let mut first = vec![0; count];
        let mut row_of = vec![0; count];
        for (row, &at) in order.iter().enumerate() {
            // 0 and −0 are one place.
            let place = vertices[at].map(|v| (v + 0.0).to_bits());
            first[row] = *rows.entry(place).or_insert(row as u64);
            row_of[at] = first[row];
        }
        let (mut edges, mut begin) = (Vec::with_capacity(count), 0);
        for ring in rings {
            let row = |i: usize| row_of[begin + i % ring.len()];
            edges.extend((0..ring.len()).map(|i| [row(i), row(i + 1)]).filter(|[a, b]| a != b));
            begin += ring.len();
        }
        Ok(Shuffled { points, edges, first })
    }

    /// The edges found by a method beside the true ones, pairs of edges that cross, and the time it took.
    fn judge(&self, options: &CurveOptions<'_>) -> Result<(EdgeScore, usize, f64)> {
        let (found, seconds) = solve(&self.points, options)?;
        let edges: Vec<[u64; 2]> = found_edges(&found.answer)
            .into_iter()
            .map(|edge| edge.map(|row| self.first[row as usize]))
            .collect();
        Ok((edge_score(&self.edges, &edges), crossings(&found_lines(&found.answer)), seconds))
    }
}

/// Rings of a file of lines `ring x y`.
fn rings(text: &str) -> Result<Vec<Ring>> {
    let mut rings: Vec<Ring> = vec![];
    let mut last = None;
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [ring, x, y] = words[..] else { anyhow::bail!("`{line}` is no line of a ring") };
        if last != Some(ring) {
            rings.push(vec![]);
            last = Some(ring);
        }
        if let Some(ring) = rings.last_mut() {
            ring.push([x.parse()?, y.parse()?]);
        }
    }
    Ok(rings)
}

/// Lets all methods work on all inputs: shares of the true edges, crossings and time. Returns what the default found.
fn compare_methods(
    context: &Context,
    out: &mut Outcome,
    caption: &str,
    inputs: &[(&str, Shuffled)],
    runs: usize,
) -> Result<Compared> {
    let threads = Some(context.last_threads());
    let mut table = Table::new(
        "method | exact | true edges found:% | false | missing | crossings | time of all:s",
    );
    let mut default = None;
    for method in METHODS {
        let options = CurveOptions { method, threads, ..CurveOptions::default() };
        let (mut total, mut crossings, mut time, mut wrong) =
            (EdgeScore::default(), 0, 0.0, vec![]);
        for (name, input) in inputs {
            let (score, crosses, mut least) = input.judge(&options)?;
            for _ in 1..runs {
                least = least.min(solve(&input.points, &options)?.1);
            }
            total.true_found += score.true_found;
            total.false_found += score.false_found;
            total.missing += score.missing;
            crossings += crosses;
            time += least;
            if !score.exact() {
                wrong.push(name);
            }
        }
        let found = Compared {
            share: total.true_found as f64 / (total.true_found + total.missing) as f64,
            exact: 1.0 - wrong.len() as f64 / inputs.len() as f64,
            crossings,
            time,
        };
        table.push(json!({
            "method": method.name(), "exact": format!("{} of {}", inputs.len() - wrong.len(), inputs.len()),
            "true edges found": found.share, "true": total.true_found, "false": total.false_found,
            "missing": total.missing, "crossings": crossings, "time of all": time, "wrong": wrong,
        }));
        default.get_or_insert(found);
    }
    out.table(caption, table);
    default.context("no method")
}

/// What a method found of all inputs.
struct Compared {
    /// The share of the true edges.
    share: f64,
    /// The share of the inputs whose edges are exactly the true ones.
    exact: f64,
    crossings: usize,
    time: f64,
}

/// Shares of the true edges, crossings and time.
pub(super) fn coastlines(context: &Context, out: &mut Outcome) -> Result<()> {
    let name = context.size("naturalearth_land_10m", "naturalearth_land_50m");
    let Some(text) = data::read_xz(&format!("curve/{name}.loops.txt.xz"))? else {
        return out.left_out();
    };
    let input = Shuffled::new(&rings(&text)?, context.seeds.start)?;
    let caption = format!("{name}, {} points, {} edges", input.points.len() / 2, input.edges.len());
    let found = compare_methods(context, out, &caption, &[(name, input)], context.runs)?;
    out.at_least("share of the true edges", found.share, [0.95, 0.97], Unit::Percent);
    out.must("no crossings", found.crossings, found.crossings == 0);
    out.at_most("time", found.time, 2.0, Unit::Seconds);
    Ok(())
}

/// A glyph: its name and its outlines, sampled.
struct Glyph {
    name: String,
    rings: Vec<Ring>,
}

/// Glyphs of lines `glyph NAME`, then `M x y`, `L x y`, `Q cx cy x y` and `Z`, sampled no coarser than `spacing`, with all corners.
fn glyphs_of(text: &str, spacing: f64) -> Result<Vec<Glyph>> {
    let mut glyphs: Vec<Glyph> = vec![];
    let mut ring: Ring = vec![];
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let command = words.next().unwrap_or_default();
        if command == "glyph" {
            let name = words.collect::<Vec<_>>().join(" ");
            glyphs.push(Glyph { name, rings: vec![] });
            continue;
        }
        let numbers: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>()?;
        let glyph = glyphs.last_mut().context("an outline before the first glyph")?;
        match (command, &numbers[..]) {
            ("M", &[x, y]) => ring = vec![[x, y]],
            ("L", &[x, y]) => append(&mut ring, None, [x, y], spacing)?,
            ("Q", &[cx, cy, x, y]) => append(&mut ring, Some([cx, cy]), [x, y], spacing)?,
            ("Z", []) => {
                let first = *ring.first().context("an outline without a beginning")?;
                if ring.last() != Some(&first) {
                    append(&mut ring, None, first, spacing)?;
                }
                ring.pop();
                glyph.rings.push(std::mem::take(&mut ring));
            }
            _ => anyhow::bail!("`{line}` is no line of an outline"),
        }
    }
    Ok(glyphs)
}

/// Appends points of a line or of a quadratic Bézier curve from the last point to `to`, equal steps of the parameter.
fn append(ring: &mut Ring, control: Option<[f64; 2]>, to: [f64; 2], spacing: f64) -> Result<()> {
    let from = *ring.last().context("an outline without a beginning")?;
    let length = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    let middle = control.unwrap_or([0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])]);
    // No step is longer than twice the longer leg of the control polygon over their number.
    let parts = (2.0 * length(from, middle).max(length(middle, to)) / spacing).ceil().max(1.0);
    ensure!(parts < 1e6, "an outline of {parts} points between two corners");
    for k in 1..=parts as usize {
        let t = k as f64 / parts;
        let bezier = |i: usize| {
            (1.0 - t) * (1.0 - t) * from[i] + 2.0 * t * (1.0 - t) * middle[i] + t * t * to[i]
        };
        ring.push(if t == 1.0 { to } else { [bezier(0), bezier(1)] });
    }
    Ok(())
}

/// The width of the stem of the letter l: the largest step to the right that its outline makes on half its height.
fn stem(glyphs: &[Glyph]) -> Option<f64> {
    let letter = glyphs.iter().find(|glyph| glyph.name.starts_with("U+006C"))?;
    let points = letter.rings.concat();
    let high = points.iter().map(|p| p[1]).fold(f64::MIN, f64::max);
    let crossing: Vec<f64> = letter
        .rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])))
        .filter(|(a, b)| (a[1] < 0.5 * high) != (b[1] < 0.5 * high))
        .map(|(a, b)| a[0] + (0.5 * high - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        .collect();
    let (low, high) = crossing.iter().fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
    (low < high).then_some(high - low)
}

/// Glyphs whose edges are exactly the true ones.
pub(super) fn glyphs(context: &Context, out: &mut Outcome) -> Result<()> {
    let Some(text) = data::read_xz("curve/dejavu_serif_glyphs.quad.txt.xz")? else {
        return out.left_out();
    };
    let coarse = glyphs_of(&text, f64::INFINITY)?;
    let spacing = stem(&coarse).context("the letter l has no stem")? / 8.0;
    let glyphs = glyphs_of(&text, spacing)?;
    let mut inputs = vec![];
    for Glyph { name, rings } in &glyphs {
        inputs.push((name.as_str(), Shuffled::new(rings, context.seeds.start)?));
    }
    let caption = format!(
        "{} glyphs, a point every {spacing:.1} units, an eighth of the stem of l",
        glyphs.len()
    );
    let found = compare_methods(context, out, &caption, &inputs, 1)?;
    out.at_least("share of the glyphs exact", found.exact, [0.8, 0.9], Unit::Percent);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const L: &str = "glyph U+006C l\nM 10 0\nL 30 0\nL 30 90\nQ 20 100 10 90\nZ\n";

    #[test]
    fn outlines_are_sampled_with_their_corners() {
        let glyphs = glyphs_of(L, 5.0).unwrap();
        let ring = &glyphs[0].rings[0];
        for corner in [[10.0, 0.0], [30.0, 0.0], [30.0, 90.0], [10.0, 90.0]] {
            assert_eq!(ring.iter().filter(|p| **p == corner).count(), 1, "{corner:?}");
        }
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            assert!((b[0] - a[0]).hypot(b[1] - a[1]) <= 5.0 + 1e-9, "{a:?} {b:?}");
        }
        assert_eq!(stem(&glyphs), Some(20.0));
        assert!(glyphs_of("M 1 2\n", 1.0).is_err() && glyphs_of("glyph a\nX 1\n", 1.0).is_err());
    }

    #[test]
    fn vertices_at_one_place_are_one() {
        let text = "0 0 0\n0 1 0\n0 1 1\n3 1 1\n3 2 1\n3 -0 0\n";
        let shuffled = Shuffled::new(&rings(text).unwrap(), 7).unwrap();
        let mut degree = HashMap::new();
        shuffled.edges.iter().flatten().for_each(|&row| *degree.entry(row).or_insert(0) += 1);
        let mut degrees: Vec<i32> = degree.into_values().collect();
        degrees.sort_unstable();
        assert_eq!(degrees, [2, 2, 4, 4]);
        assert!(rings("0 1\n").is_err());
    }
}
