//! Results are the same bytes for any number of threads.

use crate::test_folder::TestFolder;

#[test]
fn results_are_the_same_bytes_for_1_2_and_8_threads() {
    let folder = TestFolder::new();
    // Several blocks of points, so that threads have something to share.
    folder.taut("generate normal -n 30000 -d 8 -o points.npy").ends(0);
    folder.taut("generate cube -n 9000 -d 20 --type f32 -o cube.npy").ends(0);
    for line in [
        "ball points.npy --json",
        "ball points.npy --json --epsilon 1e-3 --method thesis-fast",
        "ball cube.npy --json",
        "ellipsoid points.npy --json",
        "ellipsoid points.npy --json --epsilon 0.5 --method thesis-core-set",
        "generate clusters -n 20000 -d 5",
    ] {
        let one = folder.taut(&format!("{line} --threads 1")).ends(0).out;
        for threads in [2, 8] {
            assert_eq!(
                folder.taut(&format!("{line} --threads {threads}")).ends(0).out,
                one,
                "{line}, {threads} threads"
            );
        }
    }
}

#[cfg(unix)]
#[test]
fn the_environment_sets_the_threads() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0\n1,1\n");
    folder.shell("TAUT_THREADS=2 taut ball points.csv").ends(0);
    folder.shell("TAUT_THREADS= taut ball points.csv").ends(0);
    for wrong in ["none", "0", "1025"] {
        folder.shell(&format!("TAUT_THREADS={wrong} taut ball points.csv")).ends(2).stderr_has(&[
            "TAUT_THREADS",
            wrong,
            "from 1 to 1024",
        ]);
    }
    folder.shell("TAUT_THREADS=none taut ball points.csv --threads 1").ends(0);
}
