#include "training/trainer.h"

#include <gtest/gtest.h>
#include <torch/torch.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "remomask/error.h"

namespace remomask {
namespace {

struct SmallNetImpl : torch::nn::Module {
  SmallNetImpl() {
    torch::manual_seed(5);
    first = register_module("first", torch::nn::Linear(4, 16));
    dropout = register_module("dropout", torch::nn::Dropout(0.3));
    second = register_module("second", torch::nn::Linear(16, 1));
    steps_seen = register_buffer("steps_seen", torch::zeros({1}));
  }
  torch::Tensor forward(const torch::Tensor& x) { return second(dropout(torch::relu(first(x)))); }
  torch::nn::Linear first{nullptr}, second{nullptr};
  torch::nn::Dropout dropout{nullptr};
  torch::Tensor steps_seen;
};
TORCH_MODULE(SmallNet);

class TrainerTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = (std::filesystem::temp_directory_path() /
                             ("remomask_trainer_" + std::to_string(::getpid()) + ".safetensors"))
                                .string();
  training::TrainerOptions options() const {
    training::TrainerOptions options;
    options.steps = 40;
    options.learning_rate = 1e-2;
    options.warmup_steps = 5;
    options.ema_decay = 0.9;
    options.stage_name = "small";
    return options;
  }
  // Trains until the end or until `stop_at`; returns the final tensors.
  static nn::TensorMap train(SmallNet& net, const training::TrainerOptions& options,
                             int64_t stop_at = -1, nlohmann::json config = {{"data", 1}}) {
    std::stop_source stop;
    training::Trainer trainer(*net, options, config);
    trainer.set_after_step([&](int64_t) { net->steps_seen += 1; });
    trainer.set_validation(10, [&](int64_t) {
      return std::map<std::string, double>{{"weight", net->second->weight.sum().item<double>()}};
    });
    const auto step = [&](int64_t s) {
      if (s + 1 == stop_at) stop.request_stop();
      const auto x = torch::randn({8, 4});
      return training::StepResult{(net(x).squeeze(1) - x.sum(1)).pow(2).mean(), {}};
    };
    trainer.run(step, {{}, stop.get_token()});
    return nn::module_tensors(*net);
  }
};

TEST_F(TrainerTest, ResumedRunEqualsUninterruptedRun) {
  SmallNet whole;
  const nn::TensorMap expected = train(whole, options());
  training::TrainerOptions resumed_options = options();
  resumed_options.checkpoint_path = path_;
  {
    SmallNet part;
    EXPECT_THROW(train(part, resumed_options, 17), Interrupted);
  }
  SmallNet rest;
  const nn::TensorMap result = train(rest, resumed_options);
  ASSERT_EQ(result.size(), expected.size());
  for (const auto& [name, tensor] : expected) {
    EXPECT_TRUE(result.at(name).equal(tensor)) << name;
  }
  EXPECT_EQ(result.at("steps_seen").item<float>(), 40);
}

TEST_F(TrainerTest, CheckpointOfAnotherRunIsRefused) {
  training::TrainerOptions stored = options();
  stored.checkpoint_path = path_;
  {
    SmallNet net;
    EXPECT_THROW(train(net, stored, 5), Interrupted);
  }
  SmallNet net;
  EXPECT_THROW(train(net, stored, -1, {{"data", 2}}), FileError);
}

TEST_F(TrainerTest, LossThatIsNotFiniteStops) {
  SmallNet net;
  training::Trainer trainer(*net, options(), {});
  const auto step = [&](int64_t) {
    return training::StepResult{net(torch::randn({2, 4})).sum() * std::nan(""), {}};
  };
  EXPECT_THROW(trainer.run(step, {}), Error);
}

TEST_F(TrainerTest, LearnsTheSum) {
  SmallNet net;
  training::TrainerOptions longer = options();
  longer.steps = 400;
  train(net, longer);
  torch::NoGradGuard no_grad;
  const auto x = torch::randn({64, 4});
  EXPECT_LT((net(x).squeeze(1) - x.sum(1)).pow(2).mean().item<double>(), 0.5);
}

TEST(ScheduleTest, WarmsUpAndDecays) {
  training::TrainerOptions options;
  options.steps = 110;
  options.warmup_steps = 10;
  options.learning_rate = 1;
  options.final_rate = 0.1;
  EXPECT_DOUBLE_EQ(training::scheduled_rate(options, 0), 0.1);
  EXPECT_DOUBLE_EQ(training::scheduled_rate(options, 9), 1.0);
  EXPECT_NEAR(training::scheduled_rate(options, 60), 0.55, 1e-12);
  EXPECT_NEAR(training::scheduled_rate(options, 110), 0.1, 1e-12);
}

}  // namespace
}  // namespace remomask
