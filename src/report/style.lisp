;;;; The style sheet of reports: dark text on white, one colour for what passed, another for what
;;;; failed.

(in-package #:discrepancy-finder.report)

(defparameter *style* "
:root { --text: #1d2433; --quiet: #667085; --line: #dfe3ea; --soft: #f6f7f9;
        --passed: #2563c9; --failed: #c4281c; --good: #157347; --open: #9a6700 }
* { box-sizing: border-box }
body { margin: 0; color: var(--text); background: #fff;
       font: 15px/1.5 system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial,
             'DejaVu Sans', sans-serif }
main { max-width: 1120px; margin: 0 auto; padding: 28px 28px 60px }
h1 { font-size: 26px; line-height: 1.25; margin: 0 0 6px; font-weight: 650 }
h2 { font-size: 19px; margin: 40px 0 12px; padding-bottom: 6px; font-weight: 650;
     border-bottom: 1px solid var(--line) }
h3 { font-size: 15px; margin: 26px 0 8px; font-weight: 650 }
p { margin: 0 0 10px; max-width: 80ch }
code, pre, .designator { font-family: ui-monospace, SFMono-Regular, Menlo, Consolas,
                         'DejaVu Sans Mono', monospace; font-size: 0.87em }
.quiet, .place, .meaning { color: var(--quiet) }
.place, .meaning { font-size: 12.5px }
ul, ol { margin: 0 0 12px; padding-left: 24px }
.banner { border: 1px solid var(--line); border-left: 6px solid var(--quiet); border-radius: 6px;
          padding: 18px 22px; background: var(--soft) }
.banner p:last-child { margin-bottom: 0 }
.banner .kicker { font-size: 12.5px; color: var(--quiet); margin-bottom: 4px }
.banner.discrepancy { border-left-color: var(--failed) }
.banner.discrepancy h1 { color: var(--failed) }
.banner.certified { border-left-color: var(--good) }
.banner.certified h1 { color: var(--good) }
.banner.undecided { border-left-color: var(--open) }
.banner.undecided h1 { color: var(--open) }
.figures { display: flex; flex-wrap: wrap; gap: 10px 36px; margin: 18px 0 0; padding: 0 }
.figures div { min-width: 90px }
.figures dt { font-size: 12.5px; color: var(--quiet) }
.figures dd { margin: 0; font-size: 20px; font-variant-numeric: tabular-nums }
table { border-collapse: collapse; width: 100%; margin: 0 0 12px }
th { text-align: left; font-size: 12.5px; font-weight: 600; color: var(--quiet);
     border-bottom: 1px solid #c5cbd6; padding: 5px 10px }
td { vertical-align: top; border-bottom: 1px solid var(--line); padding: 7px 10px }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
.strong { font-weight: 650 }
table.facts { width: auto }
table.facts th { border-bottom: 1px solid var(--line); font-weight: 500; padding-left: 0;
                 vertical-align: top; padding-top: 8px; white-space: nowrap }
table.strips { width: auto }
table.strips td { vertical-align: middle; padding: 2px 10px; font-size: 14px }
table.states { width: auto; min-width: 420px }
table.states td { padding: 3px 10px }
.is-true { color: var(--text) }
.is-false { color: var(--quiet) }
tr.differs td { background: #fdecea; font-weight: 600 }
.timeline .action { font-weight: 650 }
.timeline .designator { color: var(--quiet); overflow-wrap: anywhere; font-size: 12px }
.timeline td { font-size: 14px }
.timeline th:first-child { width: 52px }
.timeline td:nth-child(2) { width: 33% }
.timeline td:nth-child(3) { width: 38% }
.hidden { color: var(--quiet); font-size: 12px; margin-top: 2px }
.timeline .message { font-size: 13px; margin-top: 2px }
.changes { margin-top: 4px; font-size: 13px }
.chip { display: inline-block; padding: 0 6px; margin: 1px 0; border-radius: 4px;
        border: 1px solid var(--line); background: var(--soft); white-space: nowrap;
        font-family: ui-monospace, SFMono-Regular, Menlo, Consolas, 'DejaVu Sans Mono', monospace;
        font-size: 12px }
.chip.false { color: var(--quiet) }
.chip.marked { border-color: var(--failed); color: var(--failed); background: #fdecea }
.success { color: var(--quiet) }
.failure { color: var(--failed); font-weight: 650 }
tr.diverging td { background: #fff5f4; border-bottom: 0 }
tr.diverging td:first-child { box-shadow: inset 4px 0 0 var(--failed) }
tr.note-row td { border-bottom: 1px solid var(--line); padding-top: 0 }
.note { color: var(--failed); font-weight: 600; padding: 2px 0 6px }
.note code { font-weight: 600 }
.warning { color: var(--open) }
tr.not-run td { color: var(--quiet) }
tr.not-run .chip { color: var(--quiet); background: #fff }
pre.command { background: var(--soft); border: 1px solid var(--line); border-radius: 6px;
              padding: 10px 14px; margin: 0 0 10px; white-space: pre-wrap;
              overflow-wrap: anywhere }
pre.text { white-space: pre-wrap; overflow-wrap: anywhere; margin: 0 0 12px; line-height: 1.45 }
.edit { border: 1px solid var(--line); border-radius: 6px; padding: 10px 14px; margin: 0 0 10px }
.edit.removes { border-left: 4px solid var(--good) }
.legend { display: flex; flex-wrap: wrap; gap: 4px 20px; font-size: 13px; color: var(--quiet);
          margin: 8px 0 14px }
.legend span { display: inline-flex; align-items: center; gap: 6px }
svg { display: block; max-width: 100%; height: auto }
svg.strip { min-width: 190px }
svg text { font-family: inherit; font-size: 12px; fill: var(--text) }
svg.map text { paint-order: stroke; stroke: #fff; stroke-width: 3px; stroke-linejoin: round }
.ground { fill: #fbfcfd }
.frame { fill: none; stroke: #c5cbd6 }
.grid { fill: none; stroke: #edf0f4 }
svg .tick { font-size: 11px; fill: #8a93a3 }
.fixture-outline { fill: #e9ebef; fill-opacity: 0.75; stroke: #c2c8d2 }
.wall-outline { fill: #d4d8df; fill-opacity: 0.6; stroke: #b5bcc8 }
svg .fixture { fill: #7b8494; font-size: 11.5px }
.region { fill: #7a5cc2; fill-opacity: 0.05; stroke: #7a5cc2; stroke-opacity: 0.7;
          stroke-dasharray: 5 4 }
.region.without { fill: #fff; fill-opacity: 0.8; stroke-opacity: 0.4 }
.region.around { fill-opacity: 0.02; stroke-dasharray: 1 4 }
svg .region-name { fill: #5b3fa8; font-style: italic }
.robot-outline { fill: #dbe4f0; fill-opacity: 0.6; stroke: #8296b3; stroke-width: 0.8 }
.robot-after { fill: none; stroke: #44546d; stroke-width: 0.8; stroke-dasharray: 3 2 }
.before { fill-opacity: 0.85; stroke-width: 1 }
.after { fill: none; stroke-width: 1.6; stroke-dasharray: 3 2 }
svg .item { font-weight: 600 }
.trail { fill: none; stroke: var(--passed); stroke-width: 1; stroke-opacity: 0.35;
         stroke-linejoin: round }
.trail.main { stroke-width: 2; stroke-opacity: 0.9 }
.trail.failing { stroke: var(--failed); stroke-width: 2; stroke-opacity: 0.9 }
.stop { fill: #fff; stroke: #44546d; stroke-width: 1.5 }
.stop.diverging { fill: var(--failed); stroke: var(--failed) }
svg .stop-number { font-size: 11.5px; font-weight: 600; fill: #44546d }
svg .stop-number.diverging { fill: var(--failed) }
.passed { fill: var(--passed); fill-opacity: 0.55; stroke: #fff; stroke-width: 0.7 }
.left { fill: #fff; stroke: var(--quiet); stroke-width: 1.2 }
path.failed { fill: none; stroke: var(--failed); stroke-width: 2.4; stroke-linecap: round }
.halo { fill: none; stroke: #fff; stroke-width: 5.5; stroke-linecap: round }
.axis { stroke: #c5cbd6; stroke-width: 1.5 }
.tick-passed { stroke: var(--passed); stroke-width: 1.5; stroke-opacity: 0.55 }
.tick-failed { stroke: var(--failed); stroke-width: 1.5; stroke-opacity: 0.7 }
.tick-left { stroke: var(--quiet); stroke-width: 1.5; stroke-opacity: 0.55 }
details summary { cursor: pointer; color: var(--quiet); margin: 6px 0 }
footer { margin-top: 46px; padding-top: 10px; border-top: 1px solid var(--line);
         font-size: 12.5px; color: var(--quiet) }
/* On narrow pages maps shrink; their words do not. */
@media (max-width: 860px) { main { padding: 16px 16px 40px } th, td { padding: 5px 5px }
                            table.strips td { padding: 2px 5px; font-size: 13px }
                            .timeline th:first-child { width: 40px }
                            svg.map text:not(.fixture) { font-size: 14.5px } }
@media print { main { max-width: none; padding: 0 } h2 { break-after: avoid }
               tr, svg, .banner { break-inside: avoid } }
"
  "The style sheet of the page.")
