// How the report looks: plain, printable, readable in light and dark rooms alike.
#pragma once

namespace lumitexel {

inline constexpr const char* kPageStyle = R"css(
:root { --ink: #1d2126; --quiet: #5c6672; --line: #d9dde2; --panel: #f5f6f8; --accent: #2a5d9c; --warm: #b4541a; }
* { box-sizing: border-box; }
body { margin: 0; color: var(--ink); background: #fff; font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 40px 24px 64px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 8px; font-weight: 650; }
h2 { font-size: 20px; margin: 0 0 6px; font-weight: 650; }
h3 { font-size: 16px; margin: 24px 0 8px; font-weight: 650; }
p { max-width: 76ch; margin: 0 0 14px; color: var(--quiet); }
header p { font-size: 17px; }
header p.finding { font-size: 19px; color: var(--ink); }
header p.caution { color: var(--ink); border-left: 4px solid #c98500; padding-left: 12px; }
.first { margin-top: 24px; }
section { border-top: 1px solid var(--line); padding-top: 26px; margin-top: 36px; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(138px, 1fr)); gap: 12px; margin-top: 22px; }
.tile { background: var(--panel); border-radius: 8px; padding: 14px 16px; }
.tile b { display: block; font-size: 24px; font-weight: 650; font-variant-numeric: tabular-nums; }
.tile span { font-size: 13px; color: var(--quiet); display: block; line-height: 1.35; }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(240px, 1fr)); gap: 14px; }
.two { grid-template-columns: repeat(auto-fit, minmax(400px, 1fr)); }
.swatches { display: grid; grid-template-columns: repeat(auto-fill, minmax(170px, 1fr)); gap: 14px; }
figure { margin: 0 0 12px; }
figure img, figure svg { display: block; width: 100%; height: auto; border-radius: 6px; }
figcaption { font-size: 13px; color: var(--quiet); padding-top: 5px; line-height: 1.4; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: 4px 0 14px; }
th, td { padding: 5px 16px 5px 0; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-size: 13px; color: var(--quiet); font-weight: 600; }
th:first-child, td:first-child { text-align: left; }
.scale { max-width: 420px; margin: 4px 0 18px; font-size: 13px; color: var(--quiet); }
.scale .bar { height: 12px; border-radius: 3px; }
.scale .ends { display: flex; justify-content: space-between; }
.bars { display: grid; grid-template-columns: max-content 1fr max-content; gap: 6px 12px; align-items: center;
  font-size: 14px; max-width: 760px; margin-bottom: 18px; }
.bars .track { background: var(--panel); border-radius: 3px; height: 14px; }
.bars .fill { background: var(--accent); border-radius: 3px; height: 14px; min-width: 2px; }
.bars .fill.memory { background: var(--warm); }
.bars .value { text-align: right; font-variant-numeric: tabular-nums; }
.key { display: inline-block; width: 10px; height: 10px; border-radius: 2px; margin-right: 6px; }
svg text { font: 12px system-ui, "DejaVu Sans", sans-serif; fill: var(--quiet); }
@media print { section { break-inside: avoid; } main { padding: 0; } }
)css";

}  // namespace lumitexel
