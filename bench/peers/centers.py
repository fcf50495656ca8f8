"""k centers in the protocol of protocol.hpp: centers.py PROBLEM INPUT CENTER.

PROBLEM is one of

- `set-cover`: centers among the points, exact, by set-cover programs under HiGHS. INPUT holds many sets: in each row the
  number of its set, from 0, the number of centers, then a point. Each line asks for the next set, after the last again
  for the first. The radius sought is one of the distances; for those tried, by halving, a program asks for the fewest
  points whose balls hold all: minimize sum y_j subject to sum of y_j over d_ij <= r at least 1 for each i, y binary.
- `medoids`: the same sets by KMedoids of scikit-learn-extra, which minimizes the sum of distances, not the largest.
- `traversal-K` and `traversal-single-K`: K points of the traversal of Gonzalez (1985) by NumPy, from row 0, in double
  and in single precision.

Only the packages of the problem are loaded, before the clock runs.

What goes to CENTER are the rows chosen, as doubles, numbered within the set. Seconds of `set-cover` are those of the
distances, of building the programs and of solving them.
"""

import json
import sys
import time

import numpy


def distances(points):
    """All distances, as they are summed column by column."""
    squared = numpy.zeros((len(points), len(points)))
    for column in points.T:
        squared += (column[:, None] - column[None, :]) ** 2
    return numpy.sqrt(squared)


def fewest(near, limit):
    """Points whose rows of `near` hold all, at most `limit` of them; none where there are no so few."""
    count = len(near)
    program = highspy.HighsLp()
    program.num_col_, program.num_row_ = count, count
    program.col_cost_ = numpy.ones(count)
    program.col_lower_, program.col_upper_ = numpy.zeros(count), numpy.ones(count)
    program.row_lower_, program.row_upper_ = numpy.ones(count), numpy.full(count, highspy.kHighsInf)
    program.integrality_ = [highspy.HighsVarType.kInteger] * count
    matrix = program.a_matrix_
    matrix.format_ = highspy.MatrixFormat.kRowwise
    matrix.start_ = numpy.concatenate(([0], numpy.cumsum(near.sum(axis=1))))
    matrix.index_ = numpy.nonzero(near)[1]
    matrix.value_ = numpy.ones(int(near.sum()))
    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("threads", 1)
    solver.setOptionValue("mip_rel_gap", 0.0)
    solver.passModel(program)
    solver.run()
    if solver.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        raise RuntimeError(str(solver.getModelStatus()))
    chosen = numpy.nonzero(numpy.asarray(solver.getSolution().col_value) > 0.5)[0]
    return chosen if len(chosen) <= limit else None


def set_cover(points, k):
    """The least radius of k balls around points, and the points."""
    between = distances(points)
    radii = numpy.unique(between)
    low, high, best = 0, len(radii) - 1, numpy.array([0])
    while low < high:
        middle = (low + high) // 2
        chosen = fewest(between <= radii[middle], k)
        if chosen is None:
            low = middle + 1
        else:
            high, best = middle, chosen
    return float(between[:, best].min(axis=1).max()), best


def medoids(points, k):
    """The radius around k medoids, and the medoids."""
    chosen = KMedoids(k, random_state=0).fit(points).medoid_indices_
    return float(distances(points)[:, chosen].min(axis=1).max()), chosen


def traversal(points, k):
    """Gonzalez: each time the farthest point of all."""
    order = [0]
    least = ((points - points[0]) ** 2).sum(axis=1)
    for _ in range(1, k):
        order.append(int(least.argmax()))
        numpy.minimum(least, ((points - points[order[-1]]) ** 2).sum(axis=1), out=least)
    return float(numpy.sqrt(least.max())), order


def main():
    problem, input_path, center_path = sys.argv[1:]
    if problem == "set-cover":
        global highspy
        import highspy
    elif problem == "medoids":
        global KMedoids
        from sklearn_extra.cluster import KMedoids
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        rows = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    if problem.startswith("traversal-"):
        k = int(problem.split("-")[-1])
        points = rows.astype("f4") if "-single-" in problem else rows
        tasks = [(traversal, points, k)]
    else:
        solver = {"set-cover": set_cover, "medoids": medoids}[problem]
        sets = [rows[rows[:, 0] == number] for number in numpy.unique(rows[:, 0])]
        tasks = [(solver, part[:, 2:], int(part[0, 1])) for part in sets]
    print(json.dumps({"ready": True}), flush=True)
    for at, _ in enumerate(sys.stdin):
        solver, points, k = tasks[at % len(tasks)]
        start = time.perf_counter()
        radius, chosen = solver(points, k)
        seconds = time.perf_counter() - start
        numpy.asarray(chosen, dtype="<f8").tofile(center_path)
        print(json.dumps({"seconds": seconds, "radius": radius, "support": 0}), flush=True)


if __name__ == "__main__":
    main()
