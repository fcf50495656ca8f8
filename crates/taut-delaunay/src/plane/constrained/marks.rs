//! A triangulation with constrained edges, ready to be asked.

use super::{Piece, Pieces, Split};
use crate::simplex::{Simplex, decode};

/// The marks of a triangle: bit i for its edge opposite vertex i, and one for the inside.
const INSIDE_BIT: u8 = 1 << 3;

/// A constrained Delaunay triangulation: which edges are constrained, and which triangles lie inside the rings.
#[derive(Clone, Debug)]
pub struct Constrained {
    triangles: Vec<Simplex<3>>,
    marks: Vec<u8>,
    pieces: Vec<Piece>,
    splits: Vec<Split>,
}

impl Constrained {
    /// Marks a triangulation in which all pieces are edges, in whatever order its triangles are now.
    ///
    /// Time and memory are linear in sites, triangles and pieces.
    pub(crate) fn new(sites: usize, triangles: Vec<Simplex<3>>, pieces: Pieces) -> Constrained {
        let Pieces { pieces, splits } = pieces;
        // Where the pieces of a site begin; they are sorted by their smaller end.
        let mut begin = vec![0u32; sites + 1];
        for piece in &pieces {
            begin[piece.sites[0] as usize + 1] += 1;
        }
        for site in 0..sites {
            begin[site + 1] += begin[site];
        }
        let find = |a: u32, b: u32| {
            let (a, b) = (a.min(b), a.max(b));
            let range = *begin.get(a as usize)? as usize..*begin.get(a as usize + 1)? as usize;
            let found =
                pieces[range.clone()].binary_search_by_key(&b, |piece| piece.sites[1]).ok()?;
            Some(pieces[range.start + found])
        };
        let mut marks = vec![0; triangles.len()];
        // The same for the edges where the inside of the rings begins.
        let mut odd = vec![0u8; triangles.len()];
        for (number, t) in triangles.iter().enumerate() {
            for place in 0..3 {
                if let Some(piece) = find(t.vertices[(place + 1) % 3], t.vertices[(place + 2) % 3])
                {
                    marks[number] |= 1 << place;
                    odd[number] |= u8::from(piece.odd) << place;
                }
            }
        }
        flood(&triangles, &odd, &mut marks);
        Constrained { triangles, marks, pieces, splits }
    }

    /// The triangles with their neighbors, ghosts included.
    pub fn triangles(&self) -> &[Simplex<3>] {
        &self.triangles
    }

    /// Returns true if the edge opposite vertex `edge` of a triangle belongs to a segment.
    ///
    /// # Panics
    /// If there is no such triangle or edge.
    pub fn is_constrained(&self, triangle: u32, edge: usize) -> bool {
        assert!(edge < 3, "a triangle has edges 0 to 2, not {edge}");
        self.marks[triangle as usize] & 1 << edge != 0
    }

    /// Returns true if a way from outside to this triangle crosses the rings an odd number of times.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn is_inside(&self, triangle: u32) -> bool {
        self.marks[triangle as usize] & INSIDE_BIT != 0
    }

    /// The constrained edges, in the order of their ends.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The sites that segments go through.
    pub fn splits(&self) -> &[Split] {
        &self.splits
    }

    /// The triangles again, for whoever needs nothing else.
    pub fn into_triangles(self) -> Vec<Simplex<3>> {
        self.triangles
    }
}

/// Goes from the ghosts, which are outside, to all triangles; an odd edge changes sides. As rings close, the way does
/// not matter.
fn flood(triangles: &[Simplex<3>], odd: &[u8], marks: &mut [u8]) {
    let mut seen: Vec<bool> = triangles.iter().map(Simplex::is_ghost).collect();
    let mut next: Vec<u32> = (0..triangles.len() as u32).filter(|&t| seen[t as usize]).collect();
    while let Some(number) = next.pop() {
        let here = marks[number as usize] & INSIDE_BIT;
        for (place, &code) in triangles[number as usize].neighbors.iter().enumerate() {
            let (other, _) = decode(code);
            if !std::mem::replace(&mut seen[other as usize], true) {
                let crossed = odd[number as usize] >> place & 1;
                marks[other as usize] |= here ^ (crossed << 3);
                next.push(other);
            }
        }
    }
}
