#!/usr/bin/env bash
# Diagnoses published records of real machines and writes docs/research/case_studies.md.
#
#     scripts/make_case_studies.sh REAL ANSWERS [build folder]
#
# REAL holds porcaro-drum-arm/, zagreb-dmsp10-250/, cavatappi/ and bellows/; the measurements are not part of the project. The mappings in docs/examples/import
# make recordings of them, in ANSWERS/recordings; diagnoses are kept in ANSWERS, and those that are there already are not made again. About
# twenty minutes on one core. Only derived numbers reach the page.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
if (($# < 2)); then
  echo "usage: make_case_studies.sh REAL ANSWERS [build folder]" >&2
  exit 2
fi
real=$1 answers=$2 program=$(readlink -f "${3:-$root/build/release}/musclesim")
for folder in porcaro-drum-arm zagreb-dmsp10-250 cavatappi bellows; do
  [[ -d $real/$folder ]] || { echo "make_case_studies.sh: there is no $real/$folder; nothing is changed (the measurements are not part of the project)" >&2; exit 0; }
done
mkdir -p "$answers/recordings"
real=$(readlink -f "$real") answers=$(readlink -f "$answers")
maps=$root/docs/examples/import

make_recording() { "$program" import "$real/$1" "$maps/$2.toml" "$answers/recordings/$2.csv" --quiet --overwrite; }
make_recording porcaro-drum-arm/raw_step_response.csv wrist_step
make_recording porcaro-drum-arm/fig1b_step_real.csv wrist_step_repeat
make_recording porcaro-drum-arm/raw_step_response.csv wrist_release
make_recording porcaro-drum-arm/raw_sweep_0_2s.csv wrist_sweep_start
make_recording porcaro-drum-arm/fig1c_sweep_real.csv wrist_sweep
make_recording porcaro-drum-arm/fig1a_hysteresis_real.csv wrist_loop
make_recording zagreb-dmsp10-250/quasistatic_cycle1_0p1V.csv bench_loop
make_recording zagreb-dmsp10-250/quasistatic_cycle1_0p1V.csv bench_loop_corrected
make_recording zagreb-dmsp10-250/step_up_0_to_4p074V_100Hz.csv bench_step
# The sweep as published, with the slow clock of its figure.
sed 's/, factor = 0.9702//' "$maps/wrist_sweep.toml" >"$answers/recordings/as_published.toml"
"$program" import "$real/porcaro-drum-arm/fig1c_sweep_real.csv" "$answers/recordings/as_published.toml" "$answers/recordings/wrist_sweep_as_published.csv" --quiet --overwrite >/dev/null
for volts in 7 9 11; do
  "$program" import "$real/bellows/1606${volts}V.txt" "$maps/bellows.toml" "$answers/recordings/bellows_$volts.csv" --quiet --overwrite
done
# The hold of a cavatappi with its outer stop, which it never reaches, at three places.
for stop_mm in 72 90 120; do
  cp "$real/cavatappi/rec_400_long.csv" "$answers/recordings/hold_$stop_mm.csv"
  sed "s/\"rig.maximum_length_mm\": 120.0/\"rig.maximum_length_mm\": $stop_mm.0/" "$real/cavatappi/rec_400_long.json" >"$answers/recordings/hold_$stop_mm.json"
done

# NAME TUNED RECORDING...: the last recording measures the result. $excluded effects are no candidates.
excluded=""
diagnose() {
  local name=$1 tuned=$2
  shift 2
  [[ -e $answers/$name/diagnosis.json ]] && return
  echo "$name" >&2
  (cd "$answers/recordings" && "$program" diagnose "${@/%/.csv}" ${tuned:+--tune "$tuned"} ${excluded:+--exclude "$excluded"} --jobs 1 --out "$answers/$name" --quiet)
  git -C "$root" rev-parse --short HEAD >"$answers/$name/version"
}
lever=wrist.lever_mm,wrist.rest_length_0_mm,wrist.rest_length_1_mm
load=spring_bench.load_N,spring_bench.spring_N_per_mm,spring_bench.rest_length_mm
diagnose wrist_sweep $lever,wrist.own_inertia_kgm2 wrist_step wrist_release wrist_sweep_start wrist_step_repeat wrist_sweep
diagnose wrist_sweep_as_published $lever,wrist.own_inertia_kgm2 wrist_step wrist_release wrist_sweep_start wrist_step_repeat wrist_sweep_as_published
diagnose wrist_sweep_by_itself $lever,wrist.own_inertia_kgm2 wrist_sweep_as_published
diagnose wrist_step $lever,wrist.own_inertia_kgm2 wrist_release wrist_sweep_start wrist_sweep wrist_step
# The measured pressure stands for the command there: nothing before the force stage can be seen.
excluded=transport_delay,command_quantisation,command_dead_band,channel_swap,valve_lag,flow_limit,leak,supply_droop,volume_coupling,pressure_calibration,regulator_tail
diagnose wrist_loop $lever wrist_loop
excluded=""
diagnose bench_loop $load,force_law.bore_N,force_law.threshold_N bench_loop
diagnose bench_loop_corrected $load,force_law.bore_N,force_law.threshold_N bench_loop_corrected
diagnose bench_step $load bench_step
diagnose bench_step_whole $load,force_law.bore_N,force_law.threshold_N bench_step bench_loop
for stop_mm in 72 90 120; do diagnose cavatappi_$stop_mm "" hold_$stop_mm; done
diagnose bellows elbow.forearm_kg,elbow.forearm_inertia_kgm2,force_law.c_kgf bellows_7 bellows_9 bellows_11

python3 "$root/scripts/case_studies.py" "$answers" >"$answers/case_studies.md"
cp "$answers/case_studies.md" "$root/docs/research/case_studies.md"
chmod 644 "$root/docs/research/case_studies.md"
echo "docs/research/case_studies.md" >&2
