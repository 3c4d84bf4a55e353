#include "report_page.h"

namespace musclesim {

std::string reportStyle() {
  return R"css(
:root{--ink:#222;--soft:#555;--line:#ccc;--paper:#f4f4f4;--sign:#444;--before:#c8500a;--after:#0b4f9e}
*{box-sizing:border-box}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);max-width:60rem;margin:1rem auto;padding:0 1rem;overflow-wrap:break-word}
h1{font-size:1.1rem;font-weight:normal;color:var(--soft);margin:.5rem 0}h2{font-size:1.25rem;border-bottom:1px solid var(--line);margin-top:2.2rem}
h3{font-size:1.05rem;margin:0}p{margin:.6rem 0}code{font-size:.9em;overflow-wrap:anywhere}.word{display:inline-block;max-width:100%}.small{font-size:.9rem;color:var(--soft)}
.verdict{border:2px solid var(--sign);border-left-width:.7rem;border-radius:.4rem;padding:.8rem 1rem;background:#fafafa}
.explained{--sign:#14683c}.partly{--sign:#a65f00}.cannot_tell{--sign:#444}.no_gap{--sign:#1b4f91}
.signal{display:flex;gap:.9rem;align-items:center}.sign{flex:0 0 4rem;width:4rem;height:4rem;fill:var(--sign)}
.sign .mark{fill:none;stroke:#fff;stroke-width:6;stroke-linecap:round;stroke-linejoin:round}
.signal strong{display:block;font-size:1.35rem;line-height:1.2;color:var(--sign)}
.headline{font-size:1.3rem;line-height:1.35;margin:.8rem 0 .4rem}.headline li{margin:.2rem 0}.headline p{margin:.3rem 0}.headline ul{margin:.3rem 0;padding-left:1.4rem}
dl.answers{display:grid;grid-template-columns:11rem 1fr;margin:.8rem 0 0}dl.answers>*{border-top:1px solid var(--line);margin:0;padding:.4rem 0}
dl.answers dt{font-weight:bold}dl.answers p{margin:0 0 .3rem}dl.answers ol,dl.answers ul{margin:0;padding-left:1.3rem}
@media(max-width:44rem){dl.answers{display:block}dl.answers dd{border-top:0;padding-top:0}.headline{font-size:1.1rem}}
table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.2rem .6rem;border-bottom:1px solid #ddd;vertical-align:top}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
@media screen and (max-width:44rem){table.wide thead{display:none}table.wide tr{display:block;border-bottom:1px solid var(--line);padding:.4rem 0}
table.wide td{display:flex;justify-content:space-between;gap:1rem;border:0;padding:.1rem 0;text-align:right}table.wide td:empty{display:none}table.wide td::before{content:attr(data-head);color:var(--soft);text-align:left}}
.card{border:1px solid var(--line);border-radius:.4rem;padding:.8rem 1rem;margin:.8rem 0;break-inside:avoid}.card>div{display:flex;gap:1.2rem}
.card>div>:first-child{flex:1;min-width:0}.card table{margin-top:.4rem}.card summary,.more summary{cursor:pointer}
@media screen and (max-width:44rem){.card>div{display:block}}
figure{margin:.5rem 0;break-inside:avoid}svg{max-width:100%;display:block}svg text{font-family:system-ui,sans-serif}
.sketch{flex:0 0 12.5rem;width:12.5rem}.sketch svg{width:100%}.sketch text{font-size:13px;fill:#333}.sketch figcaption{font-size:.8rem;color:var(--soft)}
.sketch .axes{fill:none;stroke:#888}.sketch .expected{fill:none;stroke:var(--before);stroke-width:1.6;stroke-dasharray:5 4}.sketch .actual{fill:none;stroke:var(--ink);stroke-width:2.6}
.curve{fill:none;vector-effect:non-scaling-stroke}.measured{stroke:#a8a8a8;stroke-width:4}.before{stroke:var(--before);stroke-width:1.6;stroke-dasharray:7 4}.after{stroke:var(--after);stroke-width:1.5}
.band{fill:#d9d9d9;stroke:none}.grid{stroke:#e5e5e5;fill:none}.frame{fill:none;stroke:#999;pointer-events:none}
.trace{margin:1.4rem 0}.trace svg.plot,.loop svg.still{width:100%;height:auto;background:#fff}.plot text,.still text{font-size:12px;fill:#333}
.plot{touch-action:pan-y;cursor:crosshair}.plot:focus-visible{outline:3px solid var(--after)}.cursor{stroke:#000;stroke-width:1;pointer-events:none}.chosen{fill:#0b4f9e;opacity:.15;pointer-events:none}
@media screen and (max-width:44rem){.plot text{font-size:19px}.plot .unit{font-size:17px}.still text{font-size:13px}}
.legend{display:flex;flex-wrap:wrap;gap:.1rem 1.1rem;font-size:.85rem}.key{white-space:nowrap}.key svg{display:inline-block;width:30px;height:10px;margin-right:.35rem}output{font-variant-numeric:tabular-nums;font-weight:bold}
.tools{position:sticky;top:0;background:#fffd;padding:.3rem 0;z-index:1;font-size:.9rem}
.loops{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,20rem),1fr));gap:1rem}.loop{max-width:28rem}
.bars{margin:.7rem 0;break-inside:avoid}.bar{display:grid;grid-template-columns:19rem 1fr;gap:.5rem;align-items:center;margin:.2rem 0;font-size:.9rem;break-inside:avoid}.bar>:first-child{text-align:right}
.length{display:flex;align-items:center;gap:.5rem}.fill{height:.95rem;min-width:2px;background:#8a8a8a;print-color-adjust:exact;-webkit-print-color-adjust:exact}.strong{background:#222}
.removed{background:repeating-linear-gradient(135deg,#fff 0 3px,#0b4f9e 3px 5px);border:1px solid #0b4f9e}.added{background:#fff;border:1px dashed #222}
@media screen and (max-width:44rem){.bar{display:block}.bar>:first-child{text-align:left}}
.place{display:flex;gap:1.5rem}.place>:first-child{flex:1;min-width:0}.robot{flex:0 0 15rem;break-inside:avoid}@media screen and (max-width:44rem){.place{display:block}.robot svg{max-height:16rem}}
.term{font:inherit;color:inherit;background:none;border:0;border-bottom:2px dotted var(--after);padding:0;cursor:help}
[popover]{max-width:min(26rem,92vw);border:2px solid var(--after);border-radius:.4rem;padding:.7rem 1rem;box-shadow:0 .3rem 1rem #0004}
footer{margin-top:2.5rem;border-top:1px solid var(--line);font-size:.9rem;color:var(--soft)}
@media print{.screen,.tools{display:none}html{font-size:13px}body{max-width:none;margin:0;font-size:1rem}h2,h3,.lead,.trace figcaption,.loop figcaption,.legend{break-after:avoid}tr,p{break-inside:avoid}
.verdict,.fill,.band,.sign{print-color-adjust:exact;-webkit-print-color-adjust:exact}.trace svg.plot{max-height:8.5cm}.term{border:0}
[popover]{display:block;position:static;border:0;box-shadow:none;max-width:none;padding:0;margin:.3rem 0}}
)css";
}

}  // namespace musclesim
