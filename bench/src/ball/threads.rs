//! The same bytes for any number of threads.

use super::*;

/// Solves several inputs by each method with 1, 2 and 8 threads and compares the JSON of the solutions.
///
/// # Errors
/// When two of them differ in a single byte.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.count(10_000);
    let mut inputs = vec![
        Input::points(Distribution::Normal, n, 3)?,
        Input::points(Distribution::Normal, n, 300)?,
        Input::single(Distribution::Normal, n, 300)?,
        Input::points(Distribution::Uniform, n, 100)?,
        Input::points(Distribution::Poisson, n, 100)?,
        Input::points(Distribution::CubeVertices, n, 100)?,
        Input::points(Distribution::Sphere, n, 10)?,
        Input::points(Distribution::Shell { thickness: 1e-8 }, n, 50)?,
    ];
    for radii in Radii::ALL {
        inputs.push(Input::balls(radii, n, 10)?);
    }
    inputs.extend(Input::usps()?);

    let mut table = Table::new("input | method | bytes | threads compared");
    let mut compared = 0;
    for input in &inputs {
        for method in BallMethod::ALL {
            // The thesis' methods are followed to its ε; the default is followed to the end.
            let epsilon = match method {
                BallMethod::CoreSet => 0.0,
                BallMethod::BadoiuClarkson => 0.05,
                _ => 1e-3,
            };
            let solve = |threads| -> Result<String> {
                let inputs = input.items;
                let options = BallOptions {
                    epsilon,
                    method,
                    threads: Some(threads),
                    inputs,
                    ..Default::default()
                };
                Ok(ball(&*input.source()?, &options)?.to_json())
            };
            let one = match solve(1) {
                Ok(one) => one,
                // The thesis' methods may be for points alone; that is said, and the default must do both.
                Err(refusal) if method != BallMethod::CoreSet && input.items == Items::Balls => {
                    table.push(json!([
                        input.what,
                        method.to_string(),
                        "refused",
                        refusal.to_string()
                    ]));
                    continue;
                }
                Err(error) => return Err(error),
            };
            for threads in [2, 8] {
                ensure!(
                    one == solve(threads)?,
                    "{}: {method} with {threads} threads differs",
                    input.what
                );
            }
            table.push(json!([input.what, method.to_string(), one.len(), "1, 2, 8"]));
            compared += 1;
        }
    }
    out.table("", table);
    let shown = format!("{compared} of {compared} solutions");
    out.must("byte-identical for 1, 2 and 8 threads", shown, true);
    Ok(())
}
