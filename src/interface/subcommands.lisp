;;;; Subcommands that show what there is: the demo; and those that the script runs.

(in-package #:discrepancy-finder)

(define-subcommand "demo" (arguments options)
    (""
     "Run both variants of the paper's Example 1."
     (("seed") :type integer :documentation "seed of the samples (1)"))
  (when arguments
    (usage-problem "demo takes no arguments."))
  (demo :seed (or (getf options :seed) 1) :command (command-name))
  0)

;;; The script runs these two itself, from the sources, where it understands what follows them.

(define-subcommand "test" (arguments options)
    ("[--long] [--browser]"
     "Run the test suites; --long adds the long ones, --browser those in Chromium.")
  (usage-problem "test is run by the script discrepancy-finder, with --long, --browser or nothing ~
                  after it."))

(define-subcommand "bench" (arguments options)
    (""
     "Print the benchmarks.")
  (usage-problem "bench is run by the script discrepancy-finder, with nothing after it."))
