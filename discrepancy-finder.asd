;;;; Systems of discrepancy-finder.
;;;;
;;;; One secondary system a layer; a layer names the layers it uses, so that a forbidden
;;;; dependency does not load.  The JSON library is chosen here: cl-json where ASDF finds it,
;;;; yason where not; where neither is installed cl-json is asked for, so that Quicklisp
;;;; fetches it.  Only src/json/json.lisp knows the outcome.

(defpackage #:discrepancy-finder-system
  (:use #:cl))
(in-package #:discrepancy-finder-system)

(defclass asdf-user::shared-library-source (asdf:source-file)
  ((type :initform "cpp"))
  (:documentation "A C++ file that the C++ compiler turns into build/libNAME.so beside this file.
The environment variable CXX names another compiler than g++."))

(defmethod asdf:output-files ((operation asdf:compile-op) (file asdf-user::shared-library-source))
  ;; The second value keeps ASDF from translating the path into a cache folder: the
  ;; executable image looks for the library beside itself, in build/.
  (values (list (asdf:system-relative-pathname
                 "discrepancy-finder"
                 (format nil "build/lib~a.so" (asdf:component-name file))))
          t))

(defmethod asdf:input-files ((operation asdf:compile-op) (file asdf-user::shared-library-source))
  ;; The library is also out of date when a header or a part beside its source is newer.
  (let* ((source (asdf:component-pathname file))
         (folder (uiop:pathname-directory-pathname source)))
    (append (list source) (uiop:directory-files folder "*.h")
            (uiop:directory-files folder "*.inc"))))

(defmethod asdf:perform ((operation asdf:compile-op) (file asdf-user::shared-library-source))
  (let* ((target (asdf:output-file operation file))
         (temporary (make-pathname :type "tmp" :defaults target)))
    (ensure-directories-exist target)
    (uiop:run-program
     (list (or (uiop:getenvp "CXX") "g++")
           "-std=c++17" "-O2" "-Wall" "-Wextra" "-fPIC" "-shared" "-fvisibility=hidden"
           "-DBT_USE_DOUBLE_PRECISION" "-isystem" "/usr/include/bullet"
           (uiop:native-namestring (asdf:component-pathname file))
           "-o" (uiop:native-namestring temporary)
           "-lBulletDynamics-float64" "-lBulletCollision-float64" "-lLinearMath-float64")
     :output t :error-output :output)
    (rename-file temporary target)))

(defmethod asdf:perform ((operation asdf:load-op) (file asdf-user::shared-library-source))
  nil)

(defun json-library ()
  (cond ((asdf:find-system "cl-json" nil) "cl-json")
        ((asdf:find-system "yason" nil) "yason")
        (t "cl-json")))

(asdf:defsystem "discrepancy-finder"
  :description "Finds out where a Discrete Event Calculus model of a robot's world is wrong."
  :version "0.1.0"
  :license "MIT"
  :depends-on ("discrepancy-finder/discrepancy" "discrepancy-finder/report"
               "discrepancy-finder/json" "alexandria" "command-line-arguments")
  :pathname "src/interface/"
  :serial t
  :components ((:file "package") (:file "repl") (:file "command-line") (:file "progress")
               (:file "simulate") (:file "find-command") (:file "discrepancy-commands")
               (:file "plan-commands") (:file "theory-commands")
               (:file "table1") (:file "table1-text") (:file "table1-command")
               (:file "subcommands") (:file "image"))
  :in-order-to ((asdf:test-op (asdf:test-op "discrepancy-finder/tests"))))

(asdf:defsystem "discrepancy-finder/geometry"
  :description "Poses in space."
  :pathname "src/geometry/"
  :serial t
  :components ((:file "package") (:file "pose")))

(asdf:defsystem "discrepancy-finder/foreign"
  :description "Finding, opening and closing shared libraries; float traps."
  :depends-on ("cffi")
  :pathname "src/foreign/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "library") (:file "float-traps")
               (:file "clock")))

(asdf:defsystem "discrepancy-finder/json"
  :description "JSON text in and out, doubles bit-exact."
  :depends-on (#.(json-library))
  :pathname "src/json/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "syntax") (:file "json")
               (:file "writer")))

(asdf:defsystem "discrepancy-finder/z3"
  :description "The SMT solver Z3 through its C API."
  :depends-on ("discrepancy-finder/foreign" "cffi")
  :pathname "src/z3/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "raw")
               (:file "raw-contexts") (:file "raw-sorts") (:file "raw-terms")
               (:file "raw-bit-vectors") (:file "raw-accessors") (:file "raw-solvers")
               (:file "raw-tactics") (:file "text") (:file "context")
               (:file "sorts") (:file "terms") (:file "connectives") (:file "equality")
               (:file "arithmetic") (:file "interrupt") (:file "solver") (:file "models")
               (:file "check") (:file "smt-lib-names") (:file "smt-lib") (:file "clauses")))

(asdf:defsystem "discrepancy-finder/bullet"
  :description "Rigid-body worlds of the Bullet physics library, through a C++ shim with a C API."
  :depends-on ("discrepancy-finder/foreign" "discrepancy-finder/geometry" "cffi")
  :pathname "bullet-ffi/"
  :serial t
  :components ((asdf-user::shared-library-source "discrepancy-finder-bullet")
               (:file "package") (:file "conditions") (:file "raw") (:file "world")
               (:file "shapes") (:file "hulls") (:file "inertia") (:file "bodies")
               (:file "attachments") (:file "joints")
               (:file "queries") (:file "contacts") (:file "rays") (:file "sweeps")
               (:file "checkpoints") (:file "mechanisms") (:file "inverse-kinematics")
               (:file "motion-runs") (:file "clearances")))

(asdf:defsystem "discrepancy-finder/source"
  :description "Files of Lisp forms, read with care and with positions."
  :pathname "src/source/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "names") (:file "definitions")
               (:file "destructuring") (:file "read")))

(asdf:defsystem "discrepancy-finder/event-calculus"
  :description "Theories of the Discrete Event Calculus."
  :depends-on ("discrepancy-finder/z3" "discrepancy-finder/source")
  :pathname "src/event-calculus/"
  :serial t
  :components ((:file "package") (:file "conditions")
               (:module "language"
                :serial t
                :components ((:file "names") (:file "sorts") (:file "theory") (:file "terms")
                             (:file "formula") (:file "axioms") (:file "declarations")
                             (:file "clauses") (:file "state-constraints")
                             (:file "extending") (:file "define-theory") (:file "foundations")
                             (:file "revising")))
               (:module "grounding"
                :serial t
                :components ((:file "ground-theory") (:file "compiler") (:file "numeric")
                             (:file "formulas") (:file "relative-forms") (:file "axioms")
                             (:file "values")))
               (:module "reasoning"
                :serial t
                :components ((:file "conditions") (:file "clauses") (:file "encoding")
                             (:file "numeric-fluents") (:file "completion") (:file "propagation")
                             (:file "reasoner") (:file "asserting")
                             (:file "atoms") (:file "questions") (:file "numbers")
                             (:file "models") (:file "queries") (:file "core")
                             (:file "reasons") (:file "narration") (:file "why")
                             (:file "findings")))
               (:module "progression"
                :serial t
                :components ((:file "formulas") (:file "definitions") (:file "settle")
                             (:file "outline") (:file "dated") (:file "outlining")
                             (:file "states") (:file "initial-states") (:file "resolve")
                             (:file "trajectories") (:file "numbers") (:file "turns")
                             (:file "successors") (:file "progress")
                             (:file "footprints") (:file "windows")))
               (:module "e-files"
                :serial t
                :components ((:file "conditions") (:file "tokens") (:file "expressions")
                             (:file "statements") (:file "files") (:file "vocabulary")
                             (:file "formulas") (:file "reader") (:file "e-names")
                             (:file "sentences") (:file "writer") (:file "print-models")))))

(asdf:defsystem "discrepancy-finder/prolog"
  :description "A small Prolog with lazy solutions, in which designators are grounded."
  :pathname "src/prolog/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "lazy-lists")
               (:file "lazy-operations") (:file "bindings") (:file "terms") (:file "database")
               (:file "fact-groups") (:file "machine") (:file "handlers") (:file "control")
               (:file "lisp-predicates") (:file "list-predicates")))

(asdf:defsystem "discrepancy-finder/designators"
  :description "Symbolic descriptions of actions, motions, objects, locations, humans."
  :depends-on ("discrepancy-finder/prolog" "discrepancy-finder/geometry"
               "discrepancy-finder/source" "alexandria")
  :pathname "src/designators/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "designators") (:file "text")
               (:file "chains") (:file "descriptions") (:file "keys") (:file "known-keys")
               (:file "forms") (:file "reference") (:file "locations")
               (:file "location-solutions") (:file "poses") (:file "property-types")
               (:file "predicates")))

(asdf:defsystem "discrepancy-finder/transforms"
  :description "Vectors, quaternions, poses and transforms under the names of cl-transforms."
  :depends-on ("discrepancy-finder/geometry")
  :pathname "src/transforms/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "arguments") (:file "vectors")
               (:file "quaternions") (:file "rotations") (:file "poses") (:file "stamped")
               (:file "frames") (:file "pose-helpers")))

(asdf:defsystem "discrepancy-finder/roslisp"
  :description "The logging and the start-up functions of roslisp, without ROS."
  :pathname "src/roslisp/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "logging") (:file "node")))

(asdf:defsystem "discrepancy-finder/plan-language"
  :description "CPL, the plan language of CRAM."
  :depends-on ("discrepancy-finder/geometry" "discrepancy-finder/source"
               "discrepancy-finder/prolog" "discrepancy-finder/designators" "alexandria"
               (:require "sb-cltl2"))
  :pathname "src/plan-language/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "hooks") (:file "dynamic-bindings")
               (:file "handlers") (:file "tasks") (:file "task-tree") (:file "workers")
               (:file "clock") (:file "scheduler") (:file "failures") (:file "running")
               (:file "requests")
               (:file "top-level") (:file "fluents") (:file "fluent-operators")
               (:file "task-control") (:file "failure-handling") (:file "failure-classes")
               (:file "parallel") (:file "tags") (:file "policies") (:file "plans")
               (:file "goals") (:file "occasions") (:file "process-modules")
               (:file "executive") (:file "prolog-names") (:file "load-plan")
               (:file "indentation")))

(asdf:defsystem "discrepancy-finder/html"
  :description "HTML and SVG from lists."
  :pathname "src/html/"
  :serial t
  :components ((:file "package") (:file "html")))

(asdf:defsystem "discrepancy-finder/symbolic-execution"
  :description "Plans on all inputs at once, along the paths that a theory allows."
  :depends-on ("discrepancy-finder/event-calculus" "discrepancy-finder/plan-language"
               "discrepancy-finder/json" "discrepancy-finder/html" "alexandria"
               (:require "sb-cltl2"))
  :pathname "src/symbolic-execution/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "current-path")
               (:module "actions"
                :serial t
                :components ((:file "action-theory") (:file "bindings") (:file "clauses")
                             (:file "checks") (:file "define-action") (:file "returned-values")
                             (:file "outcomes") (:file "revising")))
               (:module "paths"
                :serial t
                :components ((:file "oracle") (:file "path") (:file "decisions") (:file "journal")))
               (:module "values"
                :serial t
                :components ((:file "symbolic-values") (:file "deciding")
                             (:file "deciding-objects") (:file "globals")
                             (:file "interpreted-functions") (:file "intervals")
                             (:file "arguments")))
               (:module "lifted"
                :serial t
                :components ((:file "table") (:file "equality") (:file "arithmetic")
                             (:file "comparison") (:file "division") (:file "types")
                             (:file "conses") (:file "sequences") (:file "arrays")
                             (:file "hash-tables") (:file "instances") (:file "symbols")
                             (:file "choices") (:file "output") (:file "fluent-operators")
                             (:file "designators") (:file "control")))
               (:file "coverage/recording")
               (:module "evaluator"
                :serial t
                :components ((:file "scope") (:file "jumps") (:file "evaluator") (:file "exits")
                             (:file "calls") (:file "inline") (:file "bindings")
                             (:file "functions") (:file "special-operators")
                             (:file "choices") (:file "conditions-in-plans")
                             (:file "definitions")
                             (:file "generic-functions")))
               (:module "exploration"
                :serial t
                :components ((:file "perform") (:file "lisp-footprints")
                             (:file "interleavings") (:file "races") (:file "trace")
                             (:file "arguments") (:file "least-models")
                             (:file "states-along") (:file "traces-of-paths") (:file "orders")
                             (:file "runs") (:file "exploration") (:file "initial-states")
                             (:file "next-trace")
                             (:file "verification") (:file "trace-json") (:file "world")))
               (:module "coverage"
                :serial t
                :components ((:file "coverage") (:file "grounds") (:file "text") (:file "html")))))

(asdf:defsystem "discrepancy-finder/projection"
  :description "Plans executed in a physical world."
  :depends-on ("discrepancy-finder/bullet" "discrepancy-finder/plan-language" "alexandria"
               "cffi" "salza2")
  :pathname "src/projection/"
  :serial t
  :components ((:file "package") (:file "conditions")
               (:module "models" :serial t
                :components ((:file "xml") (:file "xml-reader") (:file "numbers")
                             (:file "inertia") (:file "packages")
                             (:file "collada") (:file "meshes") (:file "links")
                             (:file "joints") (:file "urdf")
                             (:file "groups")))
               (:module "scenes" :serial t
                :components ((:file "clauses") (:file "parameters") (:file "scene")
                             (:file "materials") (:file "robots") (:file "reading")))
               (:module "worlds" :serial t
                :components ((:file "outlines") (:file "blueprints") (:file "robot")
                             (:file "projection") (:file "building") (:file "observations")
                             (:file "performing")))
               (:module "motions" :serial t
                :components ((:file "profiles") (:file "trail") (:file "runner") (:file "head")
                             (:file "torso")))
               (:module "navigation" :serial t
                :components ((:file "terrain") (:file "footing") (:file "connection")
                             (:file "queues")
                             (:file "base-paths") (:file "surroundings") (:file "base-motion")
                             (:file "going")))
               (:module "perception" :serial t
                :components ((:file "hulls") (:file "surface") (:file "seeing")
                             (:file "places") (:file "detecting") (:file "looking")))
               (:module "manipulation" :serial t
                :components ((:file "column-arm") (:file "extents") (:file "grasps")
                             (:file "fitting") (:file "arms") (:file "gripper") (:file "ways")
                             (:file "smooth-ways") (:file "reaching") (:file "picking")
                             (:file "placing") (:file "containers") (:file "modules")))
               (:module "actions" :serial t
                :components ((:file "places") (:file "base-poses") (:file "moving")
                             (:file "searching") (:file "environment") (:file "fetching")
                             (:file "transporting") (:file "groundings")))
               (:module "pictures" :serial t
                :components ((:file "chunks") (:file "viewpoints") (:file "png")
                             (:file "ray-casting") (:file "top-view")
                             (:file "view-world") (:file "frames")))))

(asdf:defsystem "discrepancy-finder/statistics"
  :description "Distributions, regression, and rules that decide when there are enough samples."
  :depends-on ("discrepancy-finder/geometry")
  :pathname "src/statistics/"
  :serial t
  :components ((:file "package") (:file "conditions") (:file "normal") (:file "beta")
               (:file "student") (:file "least-squares") (:file "regression") (:file "rules")
               (:file "evidence") (:file "paper-rule") (:file "zero-failure")
               (:file "prediction") (:file "mixed-evidence") (:file "worst-corners")))

(asdf:defsystem "discrepancy-finder/discrepancy"
  :description "The search for discrepancies between theory and projection."
  :depends-on ("discrepancy-finder/symbolic-execution" "discrepancy-finder/projection"
               "discrepancy-finder/statistics" "discrepancy-finder/json" "alexandria")
  :pathname "src/discrepancy/"
  :serial t
  :components ((:file "package") (:file "conditions")
               (:module "domains" :serial t
                :components ((:file "regions") (:file "observers") (:file "abstraction")
                             (:file "parsing") (:file "parsing-observers") (:file "extending")
                             (:file "define-abstraction") (:file "catalog")))
               (:module "sampling" :serial t
                :components ((:file "random") (:file "samplers") (:file "sampling")
                             (:file "starts")))
               (:module "execution" :serial t
                :components ((:file "meter") (:file "actions") (:file "execution")
                             (:file "scene-runs")))
               (:module "judgement" :serial t
                :components ((:file "memory") (:file "judgement") (:file "comparisons")))
               (:module "results" :serial t
                :components ((:file "results") (:file "search-results") (:file "statements")
                             (:file "report") (:file "result-json")))
               (:module "replay" :serial t
                :components ((:file "action-json") (:file "side-by-side") (:file "stepping")
                             (:file "replay") (:file "replay-file")))
               (:module "search" :serial t
                :components ((:file "search-state") (:file "targets") (:file "trace-search")
                             (:file "finds") (:file "store") (:file "journal") (:file "search")))
               (:module "edits" :serial t
                :components ((:file "edits") (:file "examples") (:file "conditions")
                             (:file "effects") (:file "constants") (:file "outcomes")
                             (:file "regions") (:file "check")))
               (:module "explanation" :serial t
                :components ((:file "theory") (:file "coordinates") (:file "explain")
                             (:file "text")))
               (:module "shrinking" :serial t
                :components ((:file "attempts") (:file "steps") (:file "coordinates")
                             (:file "boundary") (:file "shrink")))
               (:module "refinement" :serial t
                :components ((:file "refine") (:file "text")))
               (:file "review") (:file "brute-force")))

(asdf:defsystem "discrepancy-finder/report"
  :description "Results of searches as pages for a browser."
  :depends-on ("discrepancy-finder/discrepancy" "discrepancy-finder/json"
               "discrepancy-finder/html")
  :pathname "src/report/"
  :serial t
  :components ((:file "package") (:file "style") (:file "shots") (:file "sheet")
               (:file "regions") (:file "labels") (:file "map") (:file "strips")
               (:file "timeline") (:file "why") (:file "page")))

(asdf:defsystem "discrepancy-finder/cram-compat"
  :description "CRAM's global packages, for its plan files, where CRAM itself is absent."
  :depends-on ("discrepancy-finder/plan-language" "discrepancy-finder/transforms"
               "discrepancy-finder/roslisp")
  :pathname "src/cram-compat/"
  :serial t
  :components ((:file "package") (:file "interfaces") (:file "motions")
               (:file "projection-environments")
               (:file "table") (:file "language-names") (:file "executive-names")
               (:file "geometry-names") (:file "packages") (:file "systems") (:file "poses")))

(asdf:defsystem "discrepancy-finder/tests"
  :description "The test suites, one a layer or subject."
  :depends-on ("discrepancy-finder" "discrepancy-finder/cram-compat" "fiveam")
  :pathname "tests/"
  :serial t
  :components ((:file "package") (:file "run") (:file "fixtures")
               (:file "geometry") (:file "source") (:file "json") (:file "z3")
               (:file "z3-terms") (:file "z3-cores") (:file "z3-clauses") (:file "z3-smt-lib")
               (:file "z3-life") (:file "z3-traps")
               (:file "event-calculus")
               (:file "e-files") (:file "e-files-errors") (:file "e-files-written")
               (:module "event-calculus-suites"
                :pathname "event-calculus/"
                :serial t
                :components ((:file "scenario-checks") (:file "scenarios") (:file "schemas")
                             (:file "checklist") (:file "model-counts")
                             (:file "language") (:file "theories") (:file "language-errors")
                             (:file "hostile-theories") (:file "why") (:file "why-questions")
                             (:file "findings") (:file "numeric-fluents") (:file "queries")
                             (:file "reasoners")
                             (:file "ground-by-force") (:file "brute-force")
                             (:file "random-formulas") (:file "random-theories")
                             (:file "shrinking") (:file "differential")
                             (:file "progression-random") (:file "progression")
                             (:file "progressed-states")
                             (:file "why-random")))
               (:file "prolog") (:file "prolog-lazy-lists") (:file "prolog-predicates")
               (:file "designators") (:file "designators-resolved")
               (:file "transforms") (:file "stamped-poses") (:file "roslisp")
               (:file "plan-language") (:file "tasks") (:file "task-corners")
               (:file "fluents")
               (:file "process-modules") (:file "plan-language-table")
               (:file "malformed-plans")
               (:module "symbolic-execution"
                :serial t
                :components ((:file "evaluator") (:file "programs")
                             (:file "programs-control") (:file "programs-iteration")
                             (:file "programs-functions") (:file "programs-conditions")
                             (:file "programs-places") (:file "programs-macros")
                             (:file "programs-declarations")
                             (:file "programs-data") (:file "expansions")
                             (:file "random-programs")
                             (:file "exploration") (:file "parallel")
                             (:file "table") (:file "open-theories")
                             (:file "lifted-programs") (:file "values") (:file "lifted-changes")
                             (:file "symbolic-values")
                             (:file "lifted") (:file "lifted-random")
                             (:file "define-action") (:file "interleavings")
                             (:file "random-plans") (:file "searching") (:file "traces")
                             (:file "verification") (:file "coverage") (:file "cpl-operators")
                             (:file "plan-files") (:file "programs-on-a-path")))
               (:module "bullet" :serial t
                :components ((:file "bullet") (:file "queries") (:file "worlds")
                             (:file "rays") (:file "joints") (:file "grips") (:file "hulls")
                             (:file "contacts") (:file "checkpoints") (:file "mechanisms")
                             (:file "motion-runs") (:file "motion-clearances") (:file "refusals")))
               (:module "projection" :serial t
                :components ((:file "two-regions") (:file "head") (:file "perception")
                             (:file "urdf-errors") (:file "urdf") (:file "meshes")
                             (:file "robots") (:file "scenes") (:file "actions-kitchen")
                             (:file "worlds") (:file "navigation")
                             (:file "seeing") (:file "manipulation")
                             (:file "manipulation-kitchen") (:file "manipulation-actions")
                             (:file "actions-symbolic")
                             (:file "pictures")))
               (:module "models"
                :serial t
                :components ((:file "kitchen-theory")))
               (:module "statistics"
                :serial t
                :components ((:file "normal") (:file "distributions") (:file "least-squares")
                             (:file "paper-rule") (:file "guaranteed-rules")))
               (:module "discrepancy"
                :serial t
                :components ((:file "random") (:file "samplers") (:file "abstraction")
                             (:file "regions") (:file "search") (:file "judgement")
                             (:file "catalog") (:file "explain") (:file "review")
                             (:file "replay") (:file "search-phases") (:file "journal")
                             (:file "starts") (:file "table-top") (:file "tolerances")
                             (:file "shrink") (:file "side-by-side") (:file "edits")
                             (:file "elements") (:file "refinement")
                             (:file "blind-simulation")))
               (:module "kitchen" :pathname "projection/" :serial t
                :components ((:file "kitchen") (:file "kitchen-effects")
                             (:file "kitchen-fidelity")))
               (:module "kitchen-plans" :pathname "plans/" :serial t
                :components ((:file "bowl-and-spoon")))
               (:module "drawers" :pathname "plans/"
                :components ((:file "setting-the-table") (:file "looking-into-drawers")))
               (:file "interface") (:file "interface-search")
               (:module "report" :serial t
                :components ((:file "results") (:file "pages") (:file "browser")))
               (:file "theory-commands") (:file "table1") (:file "readme")
               (:file "tutorial")
               (:file "documentation") (:file "compilation")
               (:file "load-plan") (:file "cram-compat"))
  :perform (asdf:test-op (operation system)
             (uiop:symbol-call '#:discrepancy-finder.tests '#:run-all-tests)))

(asdf:defsystem "discrepancy-finder/bench"
  :description "The benchmarks."
  :depends-on ("discrepancy-finder")
  :pathname "bench/"
  :serial t
  :components ((:file "package") (:file "steps") (:file "plans") (:file "evaluator")
               (:file "household") (:file "clingo") (:file "bounded") (:file "progression")
               (:file "exploration") (:file "calibration") (:file "searching")
               (:file "transport")
               (:file "benchmarks")))
