# The figure of a run (the paper's Figure 11) from its recording, for restyling by hand:
#
#     gnuplot -e "run='log/runs/X/run.csv'; out='run.pdf'" log/plot_run.gnuplot
#
# `out` may end in .pdf, .png or .svg. Columns are found by name, in any order; what a recording lacks is left out.
# Above: height of the hand, target, and activity (axis on the right). Below: the pressures, or the commands without pressures.
# Optional: title='...'.

if (!exists("run")) { print "run is not given: gnuplot -e \"run='.../run.csv'; out='run.pdf'\" log/plot_run.gnuplot"; exit status 2 }
if (!exists("out")) out = "run.pdf"
if (!exists("title")) title = ""

# ---- output by the ending of `out`
ending = strlen(out) > 4 ? out[strlen(out) - 3:] : ""
if (ending eq ".png") {
  set terminal pngcairo size 1440,960 font "Helvetica,18" linewidth 1.5
} else { if (ending eq ".svg") {
  set terminal svg size 960,640 font "Helvetica,12" background "#ffffff"
} else { if (ending eq ".pdf") {
  set terminal pdfcairo size 24cm,16cm font "Helvetica,12"
} else {
  print sprintf("out = %s: must end in .pdf, .png or .svg", out); exit status 2
} } }
set output out

# ---- the recording: commas, one header row after comments; empty cells and nan are gaps (reading(n) below, not n, so that no line bridges them)
set datafile separator ","
set datafile commentschars "#"

# The header's names, each between two blanks, in the order of the file.
names = " "
keep(name) = (names = names . name . " ", 0)
stats run every ::1 nooutput
do for [i = 1:int(STATS_columns)] {
  set table $header
  plot run using (keep(stringcolumn(i))) every ::0::0 with table
  unset table
}
reading(number) = valid(number) ? column(number) : NaN
has(name) = strstrt(names, " " . name . " ") > 0
number_of(name) = words(names[1:strstrt(names, " " . name . " ")]) + 1

muscle_count = 0
while (has(sprintf("command_%d", muscle_count))) { muscle_count = muscle_count + 1 }
is_measured = has("pressure_0")
pressure_name(muscle) = sprintf(is_measured ? "pressure_%d" : "command_%d", muscle)

# ---- the muscles' names and colours; light colours have a darker casing
color_names = "gray pink brown red orange yellow green aquamarine blue purple"
colors = "#bfbfbf #ffbacc #ba1726 #ff0000 #ffa100 #fcff00 #00ff00 #40ffd4 #1a00ff #ba00f5"
casings = "#777777 #9e737e #ba1726 #ff0000 #ffa100 #9c9e00 #009e00 #289e83 #1a00ff #ba00f5"
color_of(muscle) = word(colors, muscle % 10 + 1)
casing_of(muscle) = word(casings, muscle % 10 + 1)
casing_width(muscle) = casing_of(muscle) eq color_of(muscle) ? 1.1 : 2
label_of(muscle) = sprintf("%d %s", muscle, word(color_names, muscle % 10 + 1))

# ---- layout
set multiplot
set label 1 title at screen 0.09,0.965 left noenhanced
set lmargin at screen 0.09
set rmargin at screen 0.92
set grid linecolor "#e4e4e4" linetype 1 linewidth 0.6
set border linecolor "#555555"
set tics nomirror textcolor "#333333"
set key at graph 0,1.02 left bottom horizontal Left reverse samplen 1.5 width 1
time = number_of("time_s")
stats run using time every ::1 nooutput
set xrange [STATS_min:STATS_max]

# ---- above
set tmargin at screen 0.89
set bmargin at screen 0.50
set format x ""
set ylabel "height (mm)"
above = ""
if (has("hand_y_mm")) { above = above . sprintf("run using %d:(reading(%d)) every ::1 with lines linewidth 1.8 linecolor '#de0d0d' title 'height of the hand', ", time, number_of("hand_y_mm")) }
if (has("target_y_mm")) { above = above . sprintf("run using %d:(reading(%d)) every ::1 with steps linewidth 1.8 linecolor '#ff8c00' title 'target', ", time, number_of("target_y_mm")) }
if (has("activity")) {
  set y2tics textcolor "#1a991a"
  set y2label "activity" textcolor "#1a991a"
  set y2range [0:*]
  above = sprintf("run using %d:(reading(%d)) every ::1 axes x1y2 with lines linewidth 1 linecolor '#1a991a' title 'activity', ", time, number_of("activity")) . above
}
if (above ne "") { eval "plot " . above[1:strlen(above) - 2] }

# ---- below
unset label 1
unset y2tics
unset y2label
set tmargin at screen 0.47
legend_rows = (muscle_count + 4) / 5  # whole numbers: rounded up
set bmargin at screen 0.11 + 0.03 * legend_rows
set format x "%g"
set xlabel "time (s)"
set yrange [0:1]
set ylabel is_measured ? "pressure (fraction)" : "command (fraction)"
set key at screen 0.09,0.01 left bottom horizontal Left reverse samplen 1.5 width 1 maxrows legend_rows
style = is_measured ? "lines" : "steps"  # a command is held until the next
plot for [i = muscle_count - 1:0:-1] for [layer = 0:1] run using time:(reading(number_of(pressure_name(i)))) every ::1 \
  with @style linewidth (layer ? 1.1 : casing_width(i)) linecolor rgb (layer ? color_of(i) : casing_of(i)) notitle, \
  for [i = 0:muscle_count - 1] NaN with lines linewidth 3 linecolor rgb color_of(i) title label_of(i)
unset multiplot
