    Mdouble userHGridCellSize(unsigned int level) override { return level == 0 ? 0.00201 : 0.0201; }
    double next = 0.0;
    void actionsBeforeTimeStep() override
    {
        const double now = getTime() + 1e-9;
        setTimeStep(STEPS);
        if (now < next) return;
        next += LOOK;
        const BaseParticle* ball = particleHandler.getLastObject();
        std::cout << "row " << std::setprecision(12) << getTime() << ' ' << ball->getPosition() << ' '
                  << ball->getVelocity() << ' ' << ball->getAngularVelocity() << ' '
                  << double(clock()) / CLOCKS_PER_SEC << std::endl;
    }
