//! The simplices of taut beside those of CGAL, by rows of the input.
//!
//! In general position there is one Delaunay triangulation, so the two sets are equal. Among points on one circle or
//! sphere a program may have its own choice, and of equal rows it may name another; how many simplices are in both is
//! said.

use super::*;

/// Compares the sets of all inputs of `cases`, each input once.
pub(super) fn run(context: &Context, cases: &[&Section<Case>]) -> Result<()> {
    let mut table = Table::new("input | taut | CGAL | in both | equal");
    let mut done = Vec::new();
    let options = DelaunayOptions::default();
    let file = context.file("points.f64");
    for Section { kind: case, .. } in cases {
        for input in case.inputs {
            let n = context.count(input.n);
            let distribution = input.distribution(n, case.dim)?;
            let what = format!("{distribution} -n {n} -d {}", case.dim);
            if done.contains(&what) {
                continue;
            }
            let values: Vec<f64> = generate(distribution, n, case.dim, SEED)?;
            write_raw(&file, &values)?;
            let points = Points::new(&values, case.dim)?;
            let (ours, theirs, common) = match case.dim {
                2 => compare(ours(&Plane::build(&points, &options)?), &file)?,
                _ => compare(ours(&Space::build(&points, &options)?), &file)?,
            };
            let is_equal = common == ours && ours == theirs;
            table.push(json!([what, ours, theirs, common, is_equal]));
            done.push(what);
        }
    }
    println!("{table}");
    Ok(())
}

/// The simplices by rows, each ascending, in ascending order.
fn ours<const D: usize, const V: usize>(built: &Triangulation<D, V>) -> Vec<[u32; V]> {
    let rows = |simplex| built.vertices(simplex).map(|site| built.row(site));
    sorted(built.simplices().map(rows).collect())
}

fn sorted<const V: usize>(mut simplices: Vec<[u32; V]>) -> Vec<[u32; V]> {
    simplices.iter_mut().for_each(|simplex| simplex.sort_unstable());
    simplices.sort_unstable();
    simplices
}

/// How many simplices taut has, CGAL has on the points in `file`, and both have.
fn compare<const V: usize>(ours: Vec<[u32; V]>, file: &Path) -> Result<(usize, usize, usize)> {
    let program = peer::folder().join(format!("peers/build/cgal-simplices-{}", V - 1));
    ensure!(program.exists(), "{} is not installed: run bench/setup", program.display());
    let output = Command::new(&program).arg(file).stderr(Stdio::inherit()).output();
    let output = output.with_context(|| program.display().to_string())?;
    ensure!(output.status.success(), "{} ended with {}", program.display(), output.status);
    let rows = output.stdout.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
    let theirs = sorted(rows.collect::<Vec<u32>>().as_chunks::<V>().0.to_vec());
    let common = ours.iter().filter(|simplex| theirs.binary_search(simplex).is_ok()).count();
    Ok((ours.len(), theirs.len(), common))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simplices_are_told_apart_by_their_rows_alone() {
        let values = [0.0, 0.0, 4.0, 0.0, 4.0, 3.0, 0.0, 1.0];
        let points = Points::new(&values, 2).unwrap();
        let built = Plane::build(&points, &DelaunayOptions::default()).unwrap();
        assert_eq!(ours(&built), sorted(vec![[3, 1, 0], [2, 3, 1]]));
    }
}
