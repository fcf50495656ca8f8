"""scikit-learn's classifiers in the protocol of protocol.hpp: classifiers.py NAME INPUT CENTER.

A row of the input has the label, the features, and for each of ten splits 1 where it is for training and 0 where it is for testing.
Features are scaled to mean 0 and variance 1 by the training half; QDA
adds a thousandth of the identity to covariances, as some are singular. The center that is told has the accuracies of the splits, then the
recall of each class over all splits; the radius is the mean accuracy; the seconds are those of fitting and of predicting.
"""

import json
import os
import sys
import time
import warnings

# One thread, as for all peers; numpy reads it when it is imported.
os.environ["OMP_NUM_THREADS"] = "1"

import numpy
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis, QuadraticDiscriminantAnalysis
from sklearn.linear_model import LogisticRegression
from sklearn.model_selection import GridSearchCV
from sklearn.neighbors import KernelDensity, KNeighborsClassifier
from sklearn.neural_network import MLPClassifier
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC, OneClassSVM

SPLITS = 10


class ByClass:
    """One model for each class; the class of the highest score wins."""

    def __init__(self, make, prior):
        self.make, self.prior = make, prior

    def fit(self, points, labels):
        self.classes = numpy.unique(labels)
        self.models = [self.make().fit(points[labels == label]) for label in self.classes]
        shares = [numpy.mean(labels == label) for label in self.classes]
        self.offsets = numpy.log(shares) if self.prior else numpy.zeros(len(shares))
        return self

    def predict(self, points):
        scores = [model.score_samples(points) + offset for model, offset in zip(self.models, self.offsets)]
        return self.classes[numpy.argmax(scores, axis=0)]


def parzen(points, labels):
    """The width by inner folds of the likelihood, one for all classes."""
    widths = {"bandwidth": numpy.logspace(-0.5, 1.0, 10)}
    search = GridSearchCV(KernelDensity(), widths, cv=5).fit(points)
    return ByClass(lambda: KernelDensity(bandwidth=search.best_params_["bandwidth"]), True).fit(points, labels)


def tuned_svc(points, labels):
    grid = {"C": [0.3, 1, 3, 10, 30, 100], "gamma": [g / points.shape[1] for g in (0.03, 0.1, 0.3, 1)]}
    return GridSearchCV(SVC(), grid, cv=5).fit(points, labels)


METHODS = {
    "svc": lambda p, l: SVC().fit(p, l),
    "svc-tuned": tuned_svc,
    "knn": lambda p, l: KNeighborsClassifier().fit(p, l),
    "lda": lambda p, l: LinearDiscriminantAnalysis().fit(p, l),
    "qda": lambda p, l: QuadraticDiscriminantAnalysis(reg_param=1e-3).fit(p, l),
    "logistic": lambda p, l: LogisticRegression(max_iter=2000).fit(p, l),
    "mlp": lambda p, l: MLPClassifier(max_iter=300, random_state=0).fit(p, l),
    "parzen": parzen,
    "one-class": lambda p, l: ByClass(lambda: OneClassSVM(nu=0.05), False).fit(p, l),
}


def main():
    name, input_path, center_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        rows, columns = (int(count) for count in numpy.fromfile(file, dtype="<u8", count=2))
        table = numpy.fromfile(file, dtype="<f8").reshape(rows, columns)
    labels, points, is_training = table[:, 0], table[:, 1:-SPLITS], table[:, -SPLITS:] == 1
    classes = numpy.unique(labels)
    warnings.simplefilter("ignore")
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        accuracies, right, all_of = [], numpy.zeros(len(classes)), numpy.zeros(len(classes))
        start = time.perf_counter()
        for split in range(SPLITS):
            train, test = is_training[:, split], ~is_training[:, split]
            scaler = StandardScaler().fit(points[train])
            model = METHODS[name](scaler.transform(points[train]), labels[train])
            hits = model.predict(scaler.transform(points[test])) == labels[test]
            accuracies.append(hits.mean())
            for place, label in enumerate(classes):
                right[place] += hits[labels[test] == label].sum()
                all_of[place] += (labels[test] == label).sum()
        seconds = time.perf_counter() - start
        numpy.concatenate([accuracies, right / all_of]).astype("<f8").tofile(center_path)
        print(json.dumps({"seconds": seconds, "radius": float(numpy.mean(accuracies)), "support": 0}), flush=True)


if __name__ == "__main__":
    main()
