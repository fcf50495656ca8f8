//! dev
#![allow(missing_docs)]
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let p: Vec<[f64; 2]> = std::fs::read_to_string(f).unwrap().lines().map(|l| { let mut w = l.split_whitespace().map(|x| x.parse().unwrap()); [w.next().unwrap(), w.next().unwrap()] }).collect();
    taut_reconstruct::dev(&p);
}
