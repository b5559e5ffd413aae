"""Motions made for the purpose: they show the feet as well as balance and limits allow, over a range of stiffness."""
