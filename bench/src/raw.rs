//! Raw files of generated points, larger than the memory that is allowed.

use std::fs::File;
use std::io::{BufWriter, Write};

use rayon::prelude::*;
use taut_points::{Blocks, GeneratedSource, PointSource, Rows, ScalarKind, Scratch};

use crate::prelude::*;

/// Writes normal points to a folder, block by block, unless a file of that size is there. Returns its path.
pub(crate) fn make(folder: &Path, n: u64, dim: usize) -> Result<PathBuf> {
    let path = folder.join(format!("normal-{n}x{dim}-seed{SEED}.f32"));
    let bytes = n * dim as u64 * 4;
    if path.metadata().is_ok_and(|found| found.len() == bytes) {
        return Ok(path);
    }
    println!("writing {} ({:.2} GB)", path.display(), bytes as f64 / 1e9);
    let source = GeneratedSource::new(Distribution::Normal, n, dim, SEED, ScalarKind::F32)?;
    let blocks = Blocks::of(&source);
    // Under another name first, so that a file of the right name is a whole one.
    let part = path.with_extension("part");
    let mut file = BufWriter::with_capacity(1 << 20, File::create(&part)?);
    let batch = 64 * rayon::current_num_threads() as u64;
    for first in (0..blocks.count()).step_by(batch as usize) {
        let drawn: Vec<Vec<f32>> = (first..(first + batch).min(blocks.count()))
            .into_par_iter()
            .map(|block| -> Result<Vec<f32>> {
                let mut scratch = Scratch::new();
                match source.read(blocks.range(block), &mut scratch)? {
                    Rows::F32(points) => Ok(points.values().to_vec()),
                    Rows::F64(_) => bail!("single precision was asked for"),
                }
            })
            .collect::<Result<_>>()?;
        for values in drawn {
            file.write_all(bytemuck::cast_slice(&values))?;
        }
    }
    file.flush()?;
    std::fs::rename(part, &path)?;
    Ok(path)
}
