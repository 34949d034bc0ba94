(in-package #:discrepancy-finder.tests)
