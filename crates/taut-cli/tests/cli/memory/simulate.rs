//! Simulated memories.

use crate::test_folder::TestFolder;

/// Rows of a CSV file below its header, by column.
fn rows(text: &str) -> Vec<Vec<String>> {
    let line = |line: &str| line.split(',').map(str::to_owned).collect();
    text.lines().skip(1).map(line).collect()
}

#[test]
fn misses_stand_beside_the_formula() {
    let folder = TestFolder::new();
    folder
        .taut("memory simulate transpose -n 256 --memory 32K,256K --block 64,256 -o misses.csv")
        .ends(0)
        .stdout_has(&["algorithm", "formula", "transpose", "16,384", "1.000"]);
    let text = folder.text("misses.csv");
    assert!(text.starts_with("algorithm,n,memory,block,policy,misses,write_backs,formula\n"));
    let rows = rows(&text);
    assert_eq!(rows.len(), 4);
    for row in &rows {
        let block: f64 = row[3].parse().unwrap();
        assert_eq!(row[5].parse::<f64>().unwrap(), 2.0 * 256.0 * 256.0 * 8.0 / block, "{row:?}");
        assert_eq!(row[5], row[7]);
    }
}

#[test]
fn columns_do_not_run_together() {
    let folder = TestFolder::new();
    let wide = folder.taut("memory simulate transpose -n 8 --block 1G --memory 900T").ends(0).out;
    let cells = |text: &str| -> Vec<String> {
        let last = text.lines().last().unwrap_or_default();
        last.split_whitespace().map(str::to_owned).collect()
    };
    assert_eq!(cells(&wide)[..4], ["transpose", "8", "989560464998400", "1073741824"], "{wide}");
    // 2·8·8 words in blocks of 2²⁷.
    assert_eq!(cells(&wide)[5], "9.53674316e-7", "{wide}");
    let one = folder.taut("memory simulate transpose -n 1 --memory 4K").ends(0).out;
    let misses: f64 = cells(&one)[4].parse().unwrap();
    assert_eq!(cells(&one)[5..], ["0.25".to_owned(), format!("{:.3}", misses / 0.25)], "{one}");
    let none = folder.taut("memory simulate search -n 1 --memory 4K").ends(0).out;
    assert_eq!(cells(&none).len(), 7, "{none}");
}

#[test]
fn policies_differ_and_the_best_is_the_best() {
    let folder = TestFolder::new();
    let misses = |policy: &str| -> u64 {
        let line = format!("memory simulate multiply -n 24 --memory 4K --policy {policy} -o -");
        let text = folder.taut(&line).ends(0).out;
        rows(&text)[0][5].parse().unwrap()
    };
    let [lru, fifo, random, best] = ["lru", "fifo", "random", "optimal"].map(misses);
    let all = [lru, fifo, random, best];
    assert!(all[..3].iter().all(|&other| best < other) && lru != fifo, "{all:?}");
    assert!(random != lru && random == misses("random"), "{all:?}");
    assert!(misses("lru --ways 1") > lru);
}

#[test]
fn every_algorithm_runs() {
    let folder = TestFolder::new();
    let help = folder.taut("memory simulate --help").ends(0).out;
    let mut ran = 0;
    for line in help.lines().filter_map(|line| line.trim().strip_prefix("- ")) {
        let Some((name, _)) = line.split_once(':') else { continue };
        if !["lru", "fifo", "random", "optimal", "auto", "always", "never"].contains(&name)
            && !name.contains(' ')
        {
            let small =
                format!("memory simulate {name} -n 1,2,16 --memory 1K -o {name}.csv --quiet");
            folder.taut(&small).ends(0);
            assert_eq!(folder.text(&format!("{name}.csv")).lines().count(), 4);
            ran += 1;
        }
    }
    assert_eq!(ran, 17, "{help}");
}

#[test]
fn figures_of_the_thesis_are_counted_and_drawn() {
    let folder = TestFolder::new();
    folder
        .taut("memory simulate --figure 40 -o 40.csv --draw 40.svg")
        .ends(0)
        .stdout_has(&["transpose-loops"]);
    assert!(folder.text("40.svg").contains("Transposition, n × 100"));
    assert_eq!(rows(&folder.text("40.csv")).len(), 22);
    for number in [35, 39, 44, 45, 51] {
        folder.taut(&format!("memory simulate --figure {number}")).ends(2).stderr_has(&[
            "--thesis-figure",
            &number.to_string(),
            "36 to 38",
        ]);
    }
    folder.taut("memory simulate reverse -n 100,1000 --draw reverse.html").ends(0);
    assert!(folder.text("reverse.html").contains("Misses of reverse"));
}

#[test]
fn what_is_no_memory_is_refused_by_name() {
    let folder = TestFolder::new();
    for (options, said) in [
        ("transpose --block 48", &["block", "48"][..]),
        ("transpose --memory 32 --block 64", &["memory"]),
        ("transpose --ways 0", &["ways", "0"]),
        ("transpose --ways 3", &["memory"]),
        ("transpose --policy optimal --ways 2", &["--ways"]),
        ("transpose -n 0", &["`n`", "0"]),
        ("transpose -n 1000000", &["`n`", "8192"]),
        ("transpose --base 0", &["base", "0"]),
        ("strassen -n 48", &["`n`", "power of two"]),
        ("transpose --draw picture.txt", &["picture.txt"]),
    ] {
        folder.taut(&format!("memory simulate {options}")).ends(2).stderr_has(said);
    }
    for usage in ["transposition", "--draw picture.svg", "transpose --figure 36"] {
        folder.taut(&format!("memory simulate {usage}")).ends(2);
    }
    assert!(folder.files().is_empty());
}
