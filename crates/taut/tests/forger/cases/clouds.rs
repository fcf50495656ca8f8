//! Point sets that are small and mean: ties, flats, copies, both ends of the range.

use super::Input;

use crate::random::Random;
/// Returns points in `dim` dimensions: a few of each sort.
pub fn points(dim: usize, count: usize) -> Vec<Input> {
    let mut random = Random::new("points", dim as u64);
    let mut drawn = |n: usize, number: &mut dyn FnMut(&mut Random) -> f64| -> Vec<f64> {
        (0..n * dim).map(|_| number(&mut random)).collect()
    };
    let name = |what: &str| format!("{what}, d = {dim}");
    let uniform = drawn(count, &mut |random| random.signed());
    let few = drawn(dim.min(3), &mut |random| random.signed());
    let lattice = drawn(count, &mut |random| random.between(-2, 2) as f64);
    let mut corners = vec![];
    for corner in 0..1usize << dim {
        corners.extend((0..dim).map(|j| if corner >> j & 1 == 1 { 1.0 } else { -1.0 }));
    }
    let line: Vec<f64> = (0..count)
        .flat_map(|i| (0..dim).map(move |j| (i as f64) * [3.0, -1.0, 0.5, 2.0, 7.0][j % 5]))
        .collect();
    let flat: Vec<f64> =
        uniform.chunks_exact(dim).flat_map(|row| [&row[..dim - 1], &[0.0]].concat()).collect();
    let nearly_flat: Vec<f64> = uniform
        .chunks_exact(dim)
        .flat_map(|row| [&row[..dim - 1], &[row[dim - 1] * 1e-9]].concat())
        .collect();
    let copies = [&uniform[..dim], &uniform[..2 * dim], &uniform[..dim]].concat();
    let along_axis: Vec<f64> = (0..count)
        .flat_map(|i| (0..dim).map(move |j| if j == 0 { (i * i) as f64 - 9.0 } else { 0.0 }))
        .collect();
    let scaled = |factor: f64| uniform.iter().map(|x| x * factor).collect::<Vec<f64>>();
    let far = |offset: f64| uniform.iter().map(|x| x + offset).collect::<Vec<f64>>();
    let mixed = drawn(count.min(8), &mut |random| {
        random.signed() * 10f64.powi(random.between(-300, 300) as i32)
    });
    let subnormal = drawn(count.min(8), &mut |random| 5e-324 * random.between(-9, 9) as f64);
    let ends = drawn(4, &mut |random| if random.chance(50) { 1.7e308 } else { -1.7e308 });
    let mut needles = vec![0.0; 4 * dim];
    (needles[0], needles[dim], needles[2 * dim + dim - 1]) = (1e210, -1e210, 1e-100);
    [
        ("uniform", uniform.clone()),
        ("few", few),
        ("lattice", lattice),
        ("corners", corners),
        ("line", line),
        ("along an axis", along_axis),
        ("flat", flat),
        ("nearly flat", nearly_flat),
        ("copies", copies),
        ("one place", uniform[..dim].repeat(3)),
        ("one point", uniform[..dim].to_vec()),
        ("1e-300", scaled(1e-300)),
        ("1e-160", scaled(1e-160)),
        ("1e150", scaled(1e150)),
        ("1e300", scaled(1e300)),
        ("far", far(1e8)),
        ("farther", far(1e15)),
        ("mixed", mixed),
        ("subnormal", subnormal),
        ("ends", ends),
        ("needles", needles),
    ]
    .into_iter()
    .map(|(what, values)| Input::new(name(what), values, dim))
    .collect()
}

/// Returns inputs that differ a little from one: answers for them are nearly answers for it.
pub fn relatives(input: &Input, seed: u64) -> Vec<Input> {
    let mut random = Random::new("relatives", seed);
    let mut found = vec![];
    let rounded = |x: f64| if input.is_single { f64::from(x as f32) } else { x };
    let mut add = |what: &str, values: Vec<f64>| {
        let name = format!("{} {what}", input.name);
        found.push(Input { name, values, ..input.clone() });
    };
    let mut one = input.values.clone();
    let place = random.below(one.len());
    one[place] = match input.is_single {
        true => f64::from((one[place] as f32).next_up()),
        false => one[place].next_up(),
    };
    add("with one unit more", one);
    let part = 10f64.powi(-(random.between(3, 12) as i32));
    let shaken = input.values.iter().map(|x| rounded(x * (1.0 + random.signed() * part)));
    add("shaken", shaken.collect());
    let rows = input.values.len() / input.columns;
    if rows > 1 {
        let (from, to) = (random.below(rows), random.below(rows));
        let mut values = input.values.clone();
        values.copy_within(from * input.columns..(from + 1) * input.columns, to * input.columns);
        add("with a row overwritten", values);
    }
    found
}
