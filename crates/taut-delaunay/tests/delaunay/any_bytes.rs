//! The fuzz targets' property on bytes from a generator, so that plain tests run it too.

#[path = "common/bytes.rs"]
mod bytes;

use crate::test_length::long_or;

#[test]
fn any_bytes_are_triangulated_and_the_checker_agrees() {
    let mut state = 0x2545_F491_4F6C_DD1Du64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 24) as u8
    };
    for run in 0..long_or(3000u32, 80) {
        let length = 3 + (run % 97) as usize * 3;
        let input: Vec<u8> = (0..length).map(|_| next()).collect();
        bytes::solve_and_check(2 + run as usize % 2, &input);
    }
}
