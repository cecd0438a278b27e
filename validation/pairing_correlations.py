def judged(): return {}
