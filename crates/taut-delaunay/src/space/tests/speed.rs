//! Speed, on demand: `SPACE_FILE=points.f64 cargo test --release -p taut-delaunay speed -- --ignored --nocapture`.

use super::*;

#[test]
#[ignore]
fn speed() {
    let file = std::env::var("SPACE_FILE").unwrap();
    let bytes = std::fs::read(&file).unwrap();
    let flat: Vec<f64> =
        bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    let points: Vec<[f64; 3]> = flat.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    drop((bytes, flat));
    let integral = points.iter().flatten().all(|x| x.fract() == 0.0);
    let points = hilbert(points);
    let (first, order) = rounds(&points);
    let vectors = std::env::var("SPACE_SCALAR").is_err();
    let which = std::env::var("SPACE_LEVEL").ok().map(|l| l.parse::<usize>().unwrap());
    for _ in 0..std::env::var("SPACE_REPS").map_or(3, |r| r.parse().unwrap()) {
        let begin = cpu();
        let mut mesh = Mesh::new(points.clone(), Settings { integral, filtered: true, vectors });
        if let Some(which) = which {
            mesh.level = Level::filtered()[which];
        }
        mesh.start(first);
        mesh.insert(&order).unwrap();
        let ns = (cpu() - begin) / points.len() as f64;
        let tets = mesh.simplices().iter().filter(|s| s.is_live() && !s.is_ghost()).count();
        let free = mesh.free.len();
        let slots = mesh.simplices.len();
        let (_, _, counters) = mesh.finish();
        let n = points.len() as f64;
        println!(
            "{file} {ns:.0} ns/pt, {tets} tets, slots {slots} free {free}, walk {:.2} orient {:.2} tests {:.2} replaced {:.2} {:?}",
            counters.walk_steps as f64 / n,
            counters.orientations as f64 / n,
            counters.conflict_tests as f64 / n,
            counters.replaced as f64 / n,
            counters.stages
        );
    }
}

fn cpu() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split(' ').next().unwrap().parse().unwrap()
}
