"""Test a skirt of ultrasonic sensors among random discs, and find how many sensors a robot needs."""

from __future__ import annotations

from hrsafety import plotting, reactive

skirt = reactive.UltrasonicSkirt()
for name, scene in {
    "all discs seen": reactive.SkirtScene(),
    "5 % too low": reactive.SkirtScene(unseen_share=0.05),
}.items():
    shares = reactive.skirt_test(skirt, scene=scene, layouts=25).shares(closely=0.1)
    contacts = shares.collides
    print(f"{name:15} {contacts.value:5.1%} of {contacts.runs} tests touch ({contacts.low:.1%} to {contacts.high:.1%})")

study = reactive.smallest_skirt(0.05, chassis_radius=0.4, speed=0.3, counts=range(7, 14), layouts=20)
for count, share in zip(study.counts, study.contacts, strict=True):
    print(f"{count:2} sensors: {share.value:5.1%}")
print(f"smallest number that keeps contacts below 5 %: {study.sensors}")

plotting.reactive.skirt_ring(study.skirts[0], directions=reactive.skirt.MOTION_DIRECTIONS).savefig("ring.png")
plotting.reactive.skirt_sensor_counts([study]).savefig("sensors.png")
