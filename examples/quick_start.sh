#!/bin/sh
# The five commands from logs to a simulator. The logs come from the built-in twin; put your own in their place.
set -e
out=${1:-out/quick_start}

plantar simulate Tilt3,Manual_right_roll,Manual_left_roll,Squat --preset sensors --out "$out/logs"
plantar inspect "$out/logs/robot.yaml" "$out/logs/Tilt3.parquet"
plantar identify feet "$out/logs/robot.yaml" \
    "$out/logs/Tilt3.parquet" "$out/logs/Manual_right_roll.parquet" "$out/logs/Manual_left_roll.parquet" \
    --validate "$out/logs/Squat.parquet" --out "$out/feet"
plantar validate "$out/feet/result.json" "$out/logs/robot.yaml" "$out/logs/Squat.parquet"
plantar export "$out/feet/result.json" --to mjcf --out "$out/robot_on_bushes.xml"
