"""What a foot does on the ground: contact phases, deflection, slip, balance."""
