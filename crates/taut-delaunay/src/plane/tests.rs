use super::*;
use crate::simplex::decode;
use taut_predicates::plane::{conflict, orient};

fn check(m: &Mesh) {
    for (i, t) in m.triangles.iter().enumerate() {
        for f in 0..3 {
            let (o, g) = decode(t.neighbors[f]);
            let u = &m.triangles[o as usize];
            assert_eq!(decode(u.neighbors[g]), (i as u32, f));
            assert_eq!(t.vertices[(f + 1) % 3], u.vertices[(g + 2) % 3]);
            assert_eq!(t.vertices[(f + 2) % 3], u.vertices[(g + 1) % 3]);
            if !t.is_ghost() {
                let [a, b, c] = t.vertices.map(|v| m.sites[v as usize]);
                assert!(orient(a, b, c).is_positive(), "flat {i} {t:?}");
                if u.vertices[g] != GHOST {
                    assert!(
                        !conflict(a, b, c, m.sites[u.vertices[g] as usize]),
                        "not Delaunay {i} {t:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn random() {
    let mut x = 1u64;
    let mut r = || {
        x = x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    let p: Vec<_> = (0..100).map(|_| [r(), r()]).collect();
    let mut m = Mesh::new(&p, Settings { integral: false, filtered: true, vectors: false });
    m.start([0, 1, 2]);
    check(&m);
    for i in 3..100 {
        m.insert(&[i]).unwrap();
        check(&m);
    }
}
